# in:  the table of a dataset (rows of train only are fitted on), and with what each cheap model was fitted
# out: what those models predict when they are refitted on folds and on bootstrap samples of train
rule refit:
    input:
        table="results/{dataset}/table.parquet",
        records=run_files("fit.json", [PAPER, TUNED], CHEAP_MODELS),
        code=package("refitting.py", "fitting.py", "folds.py", "datasets/table.py"),
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
        code=package(
            "refitting_shells.py",
            "refitting.py",
            "shells.py",
            "fitting.py",
            "choosing_intervals.py",
            "tables/selection.py",
            "datasets/table.py",
        ),
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
        source=source,
        seed=config["seed"],
        searched=searched_runs(),
        objective=config["objective"],
    script:
        "../scripts/refit_shells.py"


# in:  stored outputs of all models of a dataset, and the truth on validation
# out: the intervals of every method around all of them, on test and extrapolation; and which method is chosen
# One job for all methods: starting one costs more than calibrating.
rule intervals:
    input:
        unpack(stored_outputs),
        table="results/{dataset}/table.parquet",
        parameters=run_files("parameters.json", SEARCHED),
        code=package(
            *EVIDENCE_CODE,
            "calibrating.py",
            "choosing_intervals.py",
            "metrics/interval.py",
            "tables/selection.py",
        ),
        interval_code=interval_code(),
    output:
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        choice="results/{dataset}/interval_choice.csv",
    log:
        "results/logs/intervals/{dataset}.log",
    benchmark:
        "results/benchmarks/intervals/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        searched=searched_runs(),
        objective=config["objective"],
        regime=config["regime"],
    script:
        "../scripts/intervals.py"


# in:  the intervals of all methods of a dataset, what they were made from, and the truth
# out: the dataset's rows of the interval metrics, its conditional coverage, its rates of alarm
rule score_intervals:
    input:
        unpack(stored_outputs),
        table="results/{dataset}/table.parquet",
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        choice="results/{dataset}/interval_choice.csv",
        code=package(
            *EVIDENCE_CODE,
            "scoring_intervals.py",
            "scoring_regions.py",
            "conditional_coverage.py",
            "metrics/interval.py",
        ),
        region_code=region_code(),
    output:
        metrics="results/{dataset}/interval_metrics.csv",
        conditional="results/{dataset}/conditional_coverage.csv",
        alarms="results/{dataset}/alarm_rates.csv",
    log:
        "results/logs/score_intervals/{dataset}.log",
    benchmark:
        "results/benchmarks/score_intervals/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        regions=config["regions"],
    script:
        "../scripts/score_intervals.py"


# in:  the predictions of all models of a dataset, the intervals of all methods, the truth
# out: how intervals do outside train, of a few models, those that need labels out there among them, beside the oracle
rule score_outside:
    input:
        table="results/{dataset}/table.parquet",
        predictions=run_files("predictions.parquet"),
        parameters=run_files("parameters.json", SEARCHED),
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        code=package(
            *EVIDENCE_CODE,
            "scoring_outside.py",
            "choosing_intervals.py",
            "intervals/split_conformal_distance.py",
            "metrics/interval.py",
            "tables/selection.py",
        ),
        outside_code=sorted((PACKAGE / "outside").glob("*.py")),
    output:
        "results/{dataset}/extrapolation_intervals.csv",
    log:
        "results/logs/score_outside/{dataset}.log",
    benchmark:
        "results/benchmarks/score_outside/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        source=source,
        searched=searched_runs(),
        objective=config["objective"],
    script:
        "../scripts/score_outside.py"


# in:  which model and method a dataset gets, the fitted models, the rows of train and validation
# out: one file that predicts, with intervals, regions and p-values, at any command
rule calibrated_model:
    input:
        table="results/{dataset}/table.parquet",
        choice="results/{dataset}/interval_choice.csv",
        models=run_files("model.joblib"),
        shells=["results/{dataset}/shells.npz"] * asks_for("shells"),
        code=package(
            "calibrated_model.py",
            "choosing_intervals.py",
            "conformal.py",
            "evidence.py",
            "fitting.py",
            "shells.py",
        ),
    output:
        "results/{dataset}/calibrated_model.joblib",
    log:
        "results/logs/calibrated_model/{dataset}.log",
    benchmark:
        "results/benchmarks/calibrated_model/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        runs=every_run(),
    script:
        "../scripts/calibrated_model.py"
