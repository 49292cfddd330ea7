# in:  the table of a dataset (rows of train only are read); for the tuned preset, the best parameters
# out: the fitted model and the record of what it took
rule fit_paper:
    input:
        table="results/{dataset}/table.parquet",
        code=package(*FITTING_CODE),
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


# The models of all searched presets in one job: starting one costs more than most fits.
rule fit_tuned:
    input:
        table="results/{dataset}/table.parquet",
        parameters=of_searched("parameters.json"),
        code=package(*FITTING_CODE),
        model_code=model_code,
    output:
        models=of_searched("model.joblib"),
        records=of_searched("fit.json"),
    log:
        "results/logs/fit/{dataset}/{model}/tuned.log",
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


# in:  the table of a dataset (rows of train are fitted on, commands of test and extrapolation predicted), and what the
#      searches by outer shells found
# out: what every model predicts that is fitted in the target space which its search has not chosen
rule refit_spaces:
    input:
        table="results/{dataset}/table.parquet",
        parameters=run_files("parameters.json", [OUTER], COMPARED),
        code=package("refitting_spaces.py", "refitting.py", *FITTING_CODE),
    output:
        "results/{dataset}/other_spaces.parquet",
    log:
        "results/logs/refit_spaces/{dataset}.log",
    benchmark:
        "results/benchmarks/refit_spaces/{dataset}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        models=COMPARED,
        robot=robot,
        max_fit_rows=config["max_fit_rows"],
        seed=config["seed"],
    script:
        "../scripts/refit_spaces.py"
