# in:  the table of a dataset (rows of train only are read)
# out: the best parameters of a model on it by each searched preset, and the tables of all trials
# One job for all presets: starting one costs as much as many a study. The studies themselves live in results/studies:
# Snakemake deletes the outputs of a job that was cut off, and a study must outlive that to be resumed.
rule tune:
    input:
        table="results/{dataset}/table.parquet",
        code=code_of("tune"),
        model_code=model_code,
    output:
        parameters=of_searched("parameters.json"),
        trials=of_searched("trials.csv"),
    log:
        "results/logs/tune/{dataset}/{model}.log",
    benchmark:
        "results/benchmarks/tune/{dataset}/{model}.tsv"
    conda:
        SOFTWARE
    threads: 1
    params:
        presets=SEARCHED_PRESETS,
        studies=[
            f"results/studies/{{dataset}}/{{model}}_{preset}.db"
            for preset in SEARCHED_PRESETS
        ],
        robot=robot,
        tuning=config["tuning"],
        target_spaces=config["target_spaces"],
        objective=config["objective"],
        seed=config["seed"],
    script:
        "../scripts/tune.py"


# in:  the table of a dataset (rows of train only are read)
# out: the best parameters of a quantile regressor on it, and the table of all trials; the study lives in
#      results/studies, as those of the models do
rule tune_quantiles:
    input:
        table="results/{dataset}/table.parquet",
        code=code_of("tune_quantiles"),
        quantile_code=quantile_code,
    output:
        parameters="results/{dataset}/quantiles/{quantile_model}/tuned/parameters.json",
        trials="results/{dataset}/quantiles/{quantile_model}/tuned/trials.csv",
    log:
        "results/logs/tune_quantiles/{dataset}/{quantile_model}.log",
    benchmark:
        "results/benchmarks/tune_quantiles/{dataset}/{quantile_model}.tsv"
    conda:
        SOFTWARE
    threads: 1
    params:
        study="results/studies/{dataset}/quantiles_{quantile_model}.db",
        n_trials=config["tuning"]["n_quantile_trials"],
        n_folds=config["tuning"]["n_folds"],
        max_rows=config["tuning"]["max_rows"],
        seed=config["seed"],
    script:
        "../scripts/tune_quantiles.py"
