# in:  nothing
# out: the MLflow store, made once before any job logs to it
rule create_store:
    output:
        "results/mlflow_store.json",
    log:
        "results/logs/create_store.log",
    priority: 50
    conda:
        SOFTWARE
    params:
        tracking_uri=tracking_uri(),
    script:
        "../scripts/create_store.py"


# in:  the result files of a dataset
# out: its runs in the MLflow store and its champion in the registry, and their ids
rule track:
    input:
        store="results/mlflow_store.json",
        description="results/{dataset}/dataset.json",
        data_card="results/{dataset}/data_card.json",
        point="results/{dataset}/point_metrics.csv",
        models=model_manifests,
        intervals="results/{dataset}/interval_metrics.csv",
        orientation=orientation_scores,
        figures="results/{dataset}/figures",
        calibrated_model="results/{dataset}/calibrated_model.joblib",
    output:
        "results/{dataset}/mlflow_runs.json",
    log:
        "results/logs/track/{dataset}.log",
    benchmark:
        "results/benchmarks/track/{dataset}.tsv"
    priority: 40
    conda:
        SOFTWARE
    params:
        runs=every_run,
        tuned=searched_runs,
        campaign=config["campaign"],
        seed=config["seed"],
        tracking_uri=tracking_uri(),
        code=code_of("track"),
        caution=config.get("caution"),
    script:
        "../scripts/track.py"
