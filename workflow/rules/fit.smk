# in:  the table of a dataset (rows of train only are read); for the tuned preset, the best parameters
# out: the fitted model and the record of what it took
rule fit_paper:
    input:
        table="results/{dataset}/table.parquet",
        code=package("fitting.py", "estimators/position_scaler.py", "datasets/table.py"),
        model_code=model_code,
    output:
        model="results/{dataset}/{model}/paper/model.joblib",
        record="results/{dataset}/{model}/paper/fit.json",
    log:
        "results/logs/fit/{dataset}/{model}/paper.log",
    benchmark:
        "results/benchmarks/fit_paper/{dataset}/{model}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        overrides=lookup(
            dpath="sources/{dataset}/paper_params/{model}", within=config, default={}
        ),
        max_rows=max_fit_rows,
        seed=config["seed"],
    script:
        "../scripts/fit_paper.py"


rule fit_tuned:
    input:
        table="results/{dataset}/table.parquet",
        parameters="results/{dataset}/{model}/tuned/parameters.json",
        code=package("fitting.py", "estimators/position_scaler.py", "datasets/table.py"),
        model_code=model_code,
    output:
        model="results/{dataset}/{model}/tuned/model.joblib",
        record="results/{dataset}/{model}/tuned/fit.json",
    log:
        "results/logs/fit/{dataset}/{model}/tuned.log",
    benchmark:
        "results/benchmarks/fit_tuned/{dataset}/{model}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        max_rows=max_fit_rows,
        seed=config["seed"],
    script:
        "../scripts/fit_tuned.py"
