# in:  the table of a dataset (rows of train only are read)
# out: the best parameters of a model on it, and the table of all trials
# The study itself lives in results/studies: Snakemake deletes the outputs of a job that was cut off, and a study must
# outlive that to be resumed.
rule tune:
    input:
        table="results/{dataset}/table.parquet",
        code=package(
            "tuning.py",
            "folds.py",
            "fitting.py",
            "estimators/position_scaler.py",
            "datasets/table.py",
        ),
        model_code=model_code,
    output:
        parameters="results/{dataset}/{model}/tuned/parameters.json",
        trials="results/{dataset}/{model}/tuned/trials.csv",
    log:
        "results/logs/tune/{dataset}/{model}.log",
    benchmark:
        "results/benchmarks/tune/{dataset}/{model}.tsv"
    conda:
        SOFTWARE
    threads: 1
    params:
        study="results/studies/{dataset}/{model}.db",
        n_trials=config["tuning"]["n_trials"],
        n_folds=config["tuning"]["n_folds"],
        max_rows=config["tuning"]["max_rows"],
        seed=config["seed"],
    script:
        "../scripts/tune.py"
