# in:  the predictions of all models of a dataset, the intervals of all methods, what they were made from, the truth;
#      the calibrated model, for its joint intervals, where this run makes it
# out: the dataset's rows of the point metrics, of the errors per marker and in either target space; of the interval
#      metrics, conditional coverage and rates of alarm; of the intervals in extrapolation, labelled methods among them,
#      each beside the oracle; and of scores with a single row left out
rule score:
    input:
        **STORED_OUTPUTS,
        table="results/{dataset}/table.parquet",
        other_spaces=partial(refit_file, kind="spaces"),
        intervals=INTERVAL_MANIFEST,
        choice="results/{dataset}/interval_choice.csv",
        calibrated_model=calibrated_model,
    output:
        point="results/{dataset}/point_metrics.csv",
        markers="results/{dataset}/marker_errors.csv",
        spaces="results/{dataset}/target_spaces.csv",
        intervals="results/{dataset}/interval_metrics.csv",
        conditional="results/{dataset}/conditional_coverage.csv",
        alarms="results/{dataset}/alarm_rates.csv",
        extrapolation="results/{dataset}/extrapolation_intervals.csv",
        left_out="results/{dataset}/left_out.csv",
    log:
        "results/logs/score/{dataset}.log",
    benchmark:
        "results/benchmarks/score/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        robot=robot,
        objective=config["objective"],
        compared=compared_models,
        robust_models=ROBUST_MODELS,
        regions=regions_of,
        code=code_of("score", *region_modules()),
    script:
        "../scripts/score.py"


if LEARNING:

    # in:  the table of a published dataset, and what its nonlinear models were fitted with
    # out: their errors on test when they are fitted to a part of train
    rule learning_curve:
        input:
            table="results/{dataset}/table.parquet",
            models=model_manifests,
        output:
            "results/{dataset}/learning_curve.csv",
        log:
            "results/logs/learning_curve/{dataset}.log",
        benchmark:
            "results/benchmarks/learning_curve/{dataset}.tsv"
        priority: 30
        conda:
            SOFTWARE
        threads: 1
        params:
            runs=every_run,
            shown=LEARNING_MODELS,
            seed=config["seed"],
            code=code_of("learning_curve"),
        script:
            "../scripts/learning_curve.py"
