# in:  the table of a dataset and the predictions of all its runs, and of its models in the other target space
# out: the dataset's rows of the point metrics, of the errors per marker, and of those in either target space
rule score:
    input:
        table="results/{dataset}/table.parquet",
        predictions=run_files("predictions.parquet"),
        fit=run_files("fit.json"),
        predict=run_files("predict.json"),
        parameters=run_files("parameters.json", [OUTER], COMPARED),
        chosen=run_files("predictions.parquet", [OUTER], COMPARED),
        other_spaces=["results/{dataset}/other_spaces.parquet"] * bool(COMPARED),
        code=package("scoring.py", "metrics/point.py"),
    output:
        point="results/{dataset}/point_metrics.csv",
        markers="results/{dataset}/marker_errors.csv",
        spaces="results/{dataset}/target_spaces.csv",
    log:
        "results/logs/score/{dataset}.log",
    benchmark:
        "results/benchmarks/score/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    params:
        runs=every_run(),
        models=COMPARED,
    script:
        "../scripts/score.py"
