# in:  the table of a dataset (rows of train only are read)
# out: the best parameters of a model on it by each searched preset, and the tables of all trials
# One job for all presets: starting one costs as much as many a study. The studies themselves live in results/studies:
# Snakemake deletes the outputs of a job that was cut off, and a study must outlive that to be resumed.
rule tune:
    input:
        table="results/{dataset}/table.parquet",
        code=package(
            "tuning.py",
            "tuning_models.py",
            "folds.py",
            "shells.py",
            *FITTING_CODE,
        ),
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
