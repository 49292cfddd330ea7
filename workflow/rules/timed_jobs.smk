# Which jobs are timed, and where they leave their time and their record: what the report tells of them.
def recorded_jobs():
    """[rule, dataset, model, preset], benchmark and record of each job that is timed and leaves a record."""
    tuned = [run for run in every_run() if run[1] == TUNED]
    untuned = [run for run in every_run() if run[1] == PAPER]
    quantile_runs = QUANTILE_RUNS if asks_for("quantiles") else []
    tuned_quantiles = [run for run in quantile_runs if run[1] == TUNED]
    kinds = [
        ("tune", tuned, "{model}.tsv", "{model}/tuned/parameters.json"),
        ("fit_tuned", tuned, "{model}.tsv", "{model}/tuned/fit.json"),
        ("fit_paper", untuned, "{model}.tsv", "{model}/paper/fit.json"),
        (
            "tune_quantiles",
            tuned_quantiles,
            "{model}.tsv",
            "quantiles/{model}/tuned/parameters.json",
        ),
        (
            "quantiles",
            quantile_runs,
            "{model}/{preset}.tsv",
            "quantiles/{model}/{preset}/fit.json",
        ),
    ]
    return [
        (
            [name, dataset, model, preset],
            f"results/benchmarks/{name}/{dataset}/{benchmark.format(model=model, preset=preset)}",
            f"results/{dataset}/{record.format(model=model, preset=preset)}",
        )
        for dataset in config["datasets"]
        for name, runs, benchmark, record in kinds
        for model, preset in runs
    ]


def unrecorded_jobs():
    """[rule, dataset, -, -] and benchmark of each job that is timed, on all models of a dataset."""
    names = ["refit"] * asks_for("folds", "resamples") + [
        "intervals",
        "score_intervals",
    ]
    return [
        ([name, dataset, "", ""], f"results/benchmarks/{name}/{dataset}.tsv")
        for dataset in config["datasets"]
        for name in names
    ]


def report_code():
    """The package of the report, its templates with it."""
    endings = (".py", ".j2", ".css", ".js")
    return sorted(
        path for path in (PACKAGE / "report").rglob("*") if path.suffix in endings
    )
