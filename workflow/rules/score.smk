# in:  the table of a dataset and the predictions of all its runs, and of its models in the other target space
# out: the dataset's rows of the point metrics, of the errors per marker, and of those in either target space
rule score_points:
    input:
        table="results/{dataset}/table.parquet",
        predictions=run_files("predictions.parquet"),
        fit=run_files("fit.json"),
        predict=run_files("predict.json"),
        parameters=run_files("parameters.json", [OUTER], COMPARED),
        chosen=run_files("predictions.parquet", [OUTER], COMPARED),
        other_spaces=["results/{dataset}/other_spaces.parquet"] * bool(COMPARED),
        code=code_of("score_points"),
    output:
        point="results/{dataset}/point_metrics.csv",
        markers="results/{dataset}/marker_errors.csv",
        spaces="results/{dataset}/target_spaces.csv",
    log:
        "results/logs/score_points/{dataset}.log",
    benchmark:
        "results/benchmarks/score_points/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    params:
        runs=every_run(),
        models=COMPARED,
    script:
        "../scripts/score_points.py"


# in:  the intervals of all methods of a dataset, what they were made from, and the truth
# out: the dataset's rows of the interval metrics, its conditional coverage, its rates of alarm
rule score_intervals:
    input:
        unpack(stored_outputs),
        table="results/{dataset}/table.parquet",
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        choice="results/{dataset}/interval_choice.csv",
        code=code_of("score_intervals"),
        region_code=region_code(),
    output:
        metrics="results/{dataset}/interval_metrics.csv",
        conditional="results/{dataset}/conditional_coverage.csv",
        alarms="results/{dataset}/alarm_rates.csv",
    log:
        "results/logs/score_intervals/{dataset}.log",
    benchmark:
        "results/benchmarks/score_intervals/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        regions=config["regions"],
    script:
        "../scripts/score_intervals.py"


# in:  the predictions of all models of a dataset, the intervals of all methods, the truth
# out: coverage and Winkler score in extrapolation of all methods around a few models, labelled methods among them, each
#      beside the oracle
rule score_extrapolation:
    input:
        table="results/{dataset}/table.parquet",
        predictions=run_files("predictions.parquet"),
        parameters=run_files("parameters.json", SEARCHED),
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        code=code_of("score_extrapolation"),
    output:
        "results/{dataset}/extrapolation_intervals.csv",
    log:
        "results/logs/score_extrapolation/{dataset}.log",
    benchmark:
        "results/benchmarks/score_extrapolation/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        robot=robot,
        searched=searched_runs(),
        objective=config["objective"],
        robust_models=ROBUST_MODELS,
    script:
        "../scripts/score_extrapolation.py"
