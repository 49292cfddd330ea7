# in:  the table of a dataset and the predictions of all its runs
# out: the dataset's rows of the point metrics, and of the errors per marker
rule score:
    input:
        table="results/{dataset}/table.parquet",
        predictions=run_files("predictions.parquet"),
        fit=run_files("fit.json"),
        predict=run_files("predict.json"),
        code=package("scoring.py", "metrics/point.py"),
    output:
        point="results/{dataset}/point_metrics.csv",
        markers="results/{dataset}/marker_errors.csv",
    log:
        "results/logs/score/{dataset}.log",
    benchmark:
        "results/benchmarks/score/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    params:
        runs=every_run(),
    script:
        "../scripts/score.py"
