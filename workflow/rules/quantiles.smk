# in:  the table of a dataset (rows of train only are read)
# out: the best parameters of a learner of quantiles on it, and the table of all trials; the study lives in
#      results/studies, as those of the models do
rule tune_quantiles:
    input:
        table="results/{dataset}/table.parquet",
        code=package(
            "tuning_quantiles.py",
            "tuning.py",
            "folds.py",
            "quantiles.py",
            "metrics/pinball.py",
            "estimators/boosted_quantiles.py",
            "estimators/detrended.py",
            "datasets/table.py",
        ),
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


# in:  the table of a dataset (rows of train are fitted on, commands of the others predicted); for the tuned preset, the
#      best parameters
# out: a fitted learner of quantiles, and its quantiles of validation, test and extrapolation
rule quantiles:
    input:
        table="results/{dataset}/table.parquet",
        parameters=quantile_parameters,
        code=package(
            "quantiles.py",
            "bounds.py",
            "estimators/boosted_quantiles.py",
            "estimators/detrended.py",
            "datasets/table.py",
        ),
        quantile_code=quantile_code,
    output:
        model="results/{dataset}/quantiles/{quantile_model}/{preset}/model.joblib",
        quantiles="results/{dataset}/quantiles/{quantile_model}/{preset}/quantiles.parquet",
        record="results/{dataset}/quantiles/{quantile_model}/{preset}/fit.json",
    log:
        "results/logs/quantiles/{dataset}/{quantile_model}/{preset}.log",
    benchmark:
        "results/benchmarks/quantiles/{dataset}/{quantile_model}/{preset}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        confidence_levels=config["confidence_levels"],
        seed=config["seed"],
    script:
        "../scripts/quantiles.py"
