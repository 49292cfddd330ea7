# in:  the fitted models of a model's presets and the table of the dataset
# out: their predictions of every subset, and how long a row takes
# One job for all presets: starting one costs more than predicting.
rule predict:
    input:
        table="results/{dataset}/table.parquet",
        models=expand(
            "results/{{dataset}}/{{model}}/{preset}/model.joblib",
            preset=config["presets"],
        ),
        code=package("fitting.py", "estimators/position_scaler.py", "datasets/table.py"),
        model_code=model_code,
    output:
        predictions=expand(
            "results/{{dataset}}/{{model}}/{preset}/predictions.parquet",
            preset=config["presets"],
        ),
        records=expand(
            "results/{{dataset}}/{{model}}/{preset}/predict.json",
            preset=config["presets"],
        ),
    log:
        "results/logs/predict/{dataset}/{model}.log",
    priority: 20
    conda:
        SOFTWARE
    threads: 1
    script:
        "../scripts/predict.py"
