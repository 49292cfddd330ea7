# in:  the table of a dataset (rows of train are fitted on, commands of the others predicted)
# out: a fitted learner of quantiles, and its quantiles of validation, test and extrapolation
rule quantiles:
    input:
        table="results/{dataset}/table.parquet",
        code=package(
            "quantiles.py", "estimators/boosted_quantiles.py", "datasets/table.py"
        ),
        quantile_code=quantile_code,
    output:
        model="results/{dataset}/quantiles/{quantile_model}/paper/model.joblib",
        quantiles="results/{dataset}/quantiles/{quantile_model}/paper/quantiles.parquet",
        record="results/{dataset}/quantiles/{quantile_model}/paper/fit.json",
    log:
        "results/logs/quantiles/{dataset}/{quantile_model}.log",
    benchmark:
        "results/benchmarks/quantiles/{dataset}/{quantile_model}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        confidence_levels=config["confidence_levels"],
        seed=config["seed"],
    script:
        "../scripts/quantiles.py"
