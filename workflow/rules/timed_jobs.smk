# Which jobs are timed, and where they leave their time and their records: what the report tells of them.
def timed_jobs():
    """[rule, dataset, model, preset] (empty: all of them), benchmark and records of each job that is timed."""
    quantile_runs = QUANTILE_RUNS if asks_for("quantiles") else []
    searched = [[model, ""] for model in config["models"] if SEARCHED_PRESETS]
    kinds = [
        ("tune", searched, "{model}", of_searched("parameters.json")),
        ("fit_tuned", searched, "{model}", of_searched("fit.json")),
        (
            "fit_paper",
            [run for run in every_run() if run[1] == PAPER],
            "{model}",
            ["results/{dataset}/{model}/paper/fit.json"],
        ),
        (
            "tune_quantiles",
            [run for run in quantile_runs if run[1] == TUNED],
            "{model}",
            ["results/{dataset}/quantiles/{model}/tuned/parameters.json"],
        ),
        (
            "quantiles",
            quantile_runs,
            "{model}/{preset}",
            ["results/{dataset}/quantiles/{model}/{preset}/fit.json"],
        ),
        ("refit", [["", ""]] * asks_for("folds", "resamples"), "", []),
        ("refit_shells", [["", ""]] * asks_for("shells"), "", []),
        ("refit_spaces", [["", ""]] * bool(COMPARED), "", []),
        ("intervals", [["", ""]], "", []),
        ("score_intervals", [["", ""]], "", []),
        ("score_outside", [["", ""]], "", []),
    ]
    return [
        (
            [name, dataset, model, preset],
            "/".join(
                filter(
                    None,
                    [
                        f"results/benchmarks/{name}/{dataset}",
                        place.format(model=model, preset=preset),
                    ],
                )
            )
            + ".tsv",
            expand(records, dataset=dataset, model=model, preset=preset),
        )
        for dataset in config["datasets"]
        for name, runs, place, records in kinds
        for model, preset in runs
    ]


def report_code():
    """The package of the report, its templates with it."""
    endings = (".py", ".j2", ".css", ".js")
    return sorted(
        path for path in (PACKAGE / "report").rglob("*") if path.suffix in endings
    )
