# in:  the result files of a dataset
# out: its runs in the MLflow store, and their ids
rule create_store:
    output:
        "results/mlflow_store.json",
    log:
        "results/logs/create_store.log",
    priority: 50
    conda:
        SOFTWARE
    params:
        tracking_uri=config["tracking_uri"],
    script:
        "../scripts/create_store.py"


rule track:
    input:
        store=ancient("results/mlflow_store.json"),
        description="results/{dataset}/dataset.json",
        data_card="results/{dataset}/data_card.json",
        point="results/{dataset}/point_metrics.csv",
        predictions=run_files("predictions.parquet"),
        fit=run_files("fit.json"),
        parameters=run_files("parameters.json", [TUNED]),
        trials=run_files("trials.csv", [TUNED]),
        intervals="results/{dataset}/interval_metrics.csv",
        figures="results/{dataset}/figures",
        code=package("tracking/store.py", "tracking/models.py", "tracking/intervals.py"),
    output:
        "results/{dataset}/mlflow_runs.json",
    log:
        "results/logs/track/{dataset}.log",
    priority: 40
    conda:
        SOFTWARE
    params:
        runs=every_run(),
        tuned=[run for run in every_run() if run[1] == TUNED],
        campaign=config["campaign"],
        seed=config["seed"],
        tracking_uri=config["tracking_uri"],
    script:
        "../scripts/track.py"
