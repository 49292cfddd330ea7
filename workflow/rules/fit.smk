# in:  the table of a dataset (rows of train only are read)
# out: a model fitted with the paper's settings, and the record of what it took
rule fit_paper:
    input:
        table="results/{dataset}/table.parquet",
        code=code_of("fit_paper"),
        model_code=model_code,
    output:
        model="results/{dataset}/{model}/paper/model.joblib",
        record="results/{dataset}/{model}/paper/fit.json",
    log:
        "results/logs/fit_paper/{dataset}/{model}.log",
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


# in:  the table of a dataset (rows of train only are read), and the best parameters of each searched preset
# out: a model fitted with each, and the records of what they took
# One job for all presets: starting one costs more than most fits.
rule fit_tuned:
    input:
        table="results/{dataset}/table.parquet",
        parameters=of_searched("parameters.json"),
        code=code_of("fit_tuned"),
        model_code=model_code,
    output:
        models=of_searched("model.joblib"),
        records=of_searched("fit.json"),
    log:
        "results/logs/fit_tuned/{dataset}/{model}.log",
    benchmark:
        "results/benchmarks/fit_tuned/{dataset}/{model}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        robot=robot,
        max_rows=max_fit_rows,
        seed=config["seed"],
    script:
        "../scripts/fit_tuned.py"


# in:  the table of a dataset (rows of train are fitted on, commands of the others predicted); for the tuned preset, the
#      best parameters
# out: a fitted quantile regressor, and its quantiles of validation, test and extrapolation
rule fit_quantiles:
    input:
        table="results/{dataset}/table.parquet",
        parameters=quantile_parameters,
        code=code_of("fit_quantiles"),
        quantile_code=quantile_code,
    output:
        model="results/{dataset}/quantiles/{quantile_model}/{preset}/model.joblib",
        quantiles="results/{dataset}/quantiles/{quantile_model}/{preset}/quantiles.parquet",
        record="results/{dataset}/quantiles/{quantile_model}/{preset}/fit.json",
    log:
        "results/logs/fit_quantiles/{dataset}/{quantile_model}/{preset}.log",
    benchmark:
        "results/benchmarks/fit_quantiles/{dataset}/{quantile_model}/{preset}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        confidence_levels=config["confidence_levels"],
        seed=config["seed"],
    script:
        "../scripts/fit_quantiles.py"
