# in:  the fitted models of a model's presets and the table of the dataset
# out: their predictions of every subset, and how long a row takes
# One job for all presets: starting one costs more than predicting.
rule predict:
    input:
        table="results/{dataset}/table.parquet",
        models=of_presets("model.joblib"),
        code=code_of("predict"),
        model_code=model_code,
    output:
        predictions=of_presets("predictions.parquet"),
        records=of_presets("predict.json"),
    log:
        "results/logs/predict/{dataset}/{model}.log",
    benchmark:
        "results/benchmarks/predict/{dataset}/{model}.tsv"
    priority: 20
    conda:
        SOFTWARE
    threads: 1
    script:
        "../scripts/predict.py"
