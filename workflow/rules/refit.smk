# in:  the table of a dataset (rows of train only are fitted on), and with what each cheap model was fitted
# out: what those models predict when they are refitted on folds and on bootstrap samples of train
rule refit:
    input:
        table="results/{dataset}/table.parquet",
        records=run_files("fit.json", [PAPER, TUNED], CHEAP_MODELS),
        code=code_of("refit"),
    output:
        "results/{dataset}/refits.npz",
    log:
        "results/logs/refit/{dataset}.log",
    benchmark:
        "results/benchmarks/refit/{dataset}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        runs=[run for run in every_run(CHEAP_MODELS) if run[1] in (PAPER, TUNED)],
        refitting=config["refitting"],
        seed=config["seed"],
    script:
        "../scripts/refit.py"


# in:  the table of a dataset (positions of train only are read), and with what each model was fitted
# out: what a few models predict of the outer shells of train when they are refitted on the cores within
rule refit_shells:
    input:
        table="results/{dataset}/table.parquet",
        records=run_files("fit.json"),
        parameters=run_files("parameters.json", SEARCHED),
        code=code_of("refit_shells"),
    output:
        "results/{dataset}/shells.npz",
    log:
        "results/logs/refit_shells/{dataset}.log",
    benchmark:
        "results/benchmarks/refit_shells/{dataset}.tsv"
    priority: 10
    conda:
        SOFTWARE
    threads: 1
    params:
        runs=every_run(),
        shells=config["shells"],
        max_fit_rows=config["max_fit_rows"],
        robot=robot,
        seed=config["seed"],
        searched=searched_runs(),
        objective=config["objective"],
        robust_models=ROBUST_MODELS,
    script:
        "../scripts/refit_shells.py"


# in:  the table of a dataset (rows of train are fitted on, commands of test and extrapolation predicted), and the
#      best parameters by outer shells
# out: what every model predicts when it is fitted in the target space that its study has not chosen
rule refit_spaces:
    input:
        table="results/{dataset}/table.parquet",
        parameters=run_files("parameters.json", [OUTER], COMPARED),
        code=code_of("refit_spaces"),
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
