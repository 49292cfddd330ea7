for group in GROUPS:
    if not any(refit_files(group).values()):
        continue

    # in:  the table of a dataset (rows of train are fitted on, commands of test and extrapolation predicted), with what
    #      each model was fitted, and the best parameters of each search
    # out: what models predict when they are refitted: on folds and bootstrap samples of train; on inner cores of train,
    #      of the shells around them; in the target space that their study has not chosen
    rule:
        name:
            name_of("refit", group)
        input:
            table="results/{dataset}/table.parquet",
            models=model_manifests,
        output:
            **refit_files(group),
        log:
            "results/logs/refit/{dataset}.log",
        benchmark:
            "results/benchmarks/refit/{dataset}.tsv"
        wildcard_constraints:
            dataset=datasets_of(group),
        priority: 10
        conda:
            SOFTWARE
        threads: 1
        params:
            runs=every_run,
            searched=searched_runs,
            objective=config["objective"],
            cheap_models=CHEAP_MODELS,
            robust_models=ROBUST_MODELS,
            compared=compared_models,
            refitting=config["refitting"],
            shell_settings=config["shells"],
            max_fit_rows=config["max_fit_rows"],
            robot=robot,
            seed=config["seed"],
            code=code_of("refit"),
        script:
            "../scripts/refit.py"
