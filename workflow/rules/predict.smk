# in:  a fitted model and the table of its dataset
# out: its predictions of every subset, and how long a row takes
rule predict:
    input:
        table="results/{dataset}/table.parquet",
        model=f"{RUN}/model.joblib",
    output:
        predictions=f"{RUN}/predictions.parquet",
        record=f"{RUN}/predict.json",
    log:
        "results/logs/predict/{dataset}/{model}/{preset}.log",
    priority: 20
    conda:
        SOFTWARE
    threads: 1
    script:
        "../scripts/predict.py"
