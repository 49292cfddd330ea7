# in:  stored predictions or quantiles of all models of a dataset, and the truth on validation
# out: the intervals of one method around all of them, on test and extrapolation
rule intervals:
    input:
        table="results/{dataset}/table.parquet",
        sources=interval_sources,
        code=package(
            "calibrating.py",
            "quantiles.py",
            "conformal.py",
            "datasets/table.py",
            "estimators/column.py",
        ),
        interval_code=interval_code,
    output:
        "results/{dataset}/intervals/{interval_method}.parquet",
    log:
        "results/logs/intervals/{dataset}/{interval_method}.log",
    benchmark:
        "results/benchmarks/intervals/{dataset}/{interval_method}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        runs=interval_runs_of,
        confidence_levels=config["confidence_levels"],
    script:
        "../scripts/intervals.py"


# in:  the intervals of all methods of a dataset, and the truth
# out: the dataset's rows of the interval metrics
rule score_intervals:
    input:
        table="results/{dataset}/table.parquet",
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        quantiles=expand(
            "results/{{dataset}}/quantiles/{model}/paper/quantiles.parquet",
            model=config["quantile_models"],
        ),
        code=package(
            "scoring_intervals.py",
            "metrics/interval.py",
            "conformal.py",
            "quantiles.py",
        ),
    output:
        "results/{dataset}/interval_metrics.csv",
    log:
        "results/logs/score_intervals/{dataset}.log",
    priority: 30
    conda:
        SOFTWARE
    params:
        methods=config["interval_methods"],
        quantile_runs=[[name, PAPER] for name in config["quantile_models"]],
        confidence_levels=config["confidence_levels"],
    script:
        "../scripts/score_intervals.py"
