for group in GROUPS:

    # in:  the table of a dataset (rows of train are searched and fitted on, commands of the others predicted)
    # out: of each preset of a model: the fitted model, the record of what it took, its predictions of every subset; of each
    #      searched preset its best parameters, all trials, and what it predicts of held-out rows; the manifest of these
    # One job for all presets and steps: starting one costs more than most fits. The studies themselves live in
    # results/studies: Snakemake deletes the outputs of a job that was cut off, and a study must outlive that to be resumed.
    rule:
        name:
            name_of("fit_model", group)
        input:
            table="results/{dataset}/table.parquet",
        output:
            models=of_presets("model.joblib", group.presets),
            records=of_presets("fit.json", group.presets),
            predictions=of_presets("predictions.parquet", group.presets),
            parameters=of_presets("parameters.json", searched(group.presets)),
            trials=of_presets("trials.csv", searched(group.presets)),
            held_out=of_presets("held_out.npz", searched(group.presets)),
            manifest=f"results/{{dataset}}/{{model}}/{MANIFEST}",
        log:
            "results/logs/fit_model/{dataset}/{model}.log",
        benchmark:
            "results/benchmarks/fit_model/{dataset}/{model}.tsv"
        wildcard_constraints:
            dataset=datasets_of(group),
        # Before quantile regressors, which only calibrating waits for: ensembles and refits go on beside these.
        priority: 5
        conda:
            SOFTWARE
        threads: 1
        params:
            presets=group.presets,
            studies=[
                f"results/studies/{{dataset}}/{{model}}_{preset}.journal"
                for preset in searched(group.presets)
            ],
            robot=robot,
            tuning=tuning("n_trials", "n_outer_trials", "max_markers", "core_shares"),
            target_spaces=config["target_spaces"],
            objective=config["objective"],
            overrides=overrides,
            max_rows=max_fit_rows,
            seed=config["seed"],
            code=model_code,
            study_code=study_code,
        script:
            "../scripts/fit_model.py"


for group in GROUPS:
    presets = has_quantiles(group)
    tuned = [preset for preset in presets if preset == TUNED]
    if not config["quantile_models"] or not presets:
        continue

    # in:  the table of a dataset (rows of train are searched and fitted on, commands of the others predicted)
    # out: of each preset of a quantile regressor: the fitted one, its quantiles of validation, test and extrapolation,
    #      and the record of what it took; of the tuned preset its best parameters and all trials; and their manifest
    rule:
        name:
            name_of("fit_quantiles", group)
        input:
            table="results/{dataset}/table.parquet",
        output:
            models=of_quantile_presets("model.joblib", presets),
            quantiles=of_quantile_presets("quantiles.parquet", presets),
            records=of_quantile_presets("fit.json", presets),
            parameters=of_quantile_presets("parameters.json", tuned),
            trials=of_quantile_presets("trials.csv", tuned),
            manifest=f"results/{{dataset}}/quantiles/{{quantile_model}}/{MANIFEST}",
        log:
            "results/logs/fit_quantiles/{dataset}/{quantile_model}.log",
        benchmark:
            "results/benchmarks/fit_quantiles/{dataset}/{quantile_model}.tsv"
        wildcard_constraints:
            dataset=datasets_of(group),
        conda:
            SOFTWARE
        threads: 1
        params:
            presets=presets,
            study="results/studies/{dataset}/quantiles_{quantile_model}.journal",
            tuning=tuning("n_quantile_trials"),
            confidence_levels=config["confidence_levels"],
            max_rows=max_fit_rows,
            seed=config["seed"],
            code=quantile_code,
            study_code=quantile_study_code,
        script:
            "../scripts/fit_quantiles.py"


for group in GROUPS:
    if not config["ensembles"] or not searched(group.presets):
        continue

    # in:  the table of a dataset (of which weights see train alone), and of each searched run of its models the fitted
    #      model and what it predicts of held-out rows of train
    # out: of each searched preset of an ensemble: the weighted mean of the fitted models, the record of what it took, its
    #      predictions of every subset, its weights, and the steps to them; and the manifest of these files
    rule:
        name:
            name_of("fit_ensemble", group)
        input:
            table="results/{dataset}/table.parquet",
            models=pool_manifests,
        output:
            models=of_ensemble("model.joblib", group.presets),
            records=of_ensemble("fit.json", group.presets),
            predictions=of_ensemble("predictions.parquet", group.presets),
            parameters=of_ensemble("parameters.json", group.presets),
            trials=of_ensemble("trials.csv", group.presets),
            manifest=f"results/{{dataset}}/{{ensemble}}/{MANIFEST}",
        log:
            "results/logs/fit_ensemble/{dataset}/{ensemble}.log",
        benchmark:
            "results/benchmarks/fit_ensemble/{dataset}/{ensemble}.tsv"
        wildcard_constraints:
            dataset=datasets_of(group),
        conda:
            SOFTWARE
        threads: 1
        params:
            presets=searched(group.presets),
            runs=pool_runs,
            robot=robot,
            tuning=tuning("max_markers", "core_shares"),
            objective=config["objective"],
            seed=config["seed"],
            code=ensemble_code,
        script:
            "../scripts/fit_ensemble.py"
