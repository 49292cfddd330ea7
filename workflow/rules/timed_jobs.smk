# Which jobs are timed, and where their times and records are: the report shows them.
def timed_jobs():
    """[rule, dataset, model, preset] (empty: all of them), benchmark and records of each job that is timed."""
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
            [run for run in QUANTILE_RUNS if run[1] == TUNED],
            "{model}",
            ["results/{dataset}/quantiles/{model}/tuned/parameters.json"],
        ),
        (
            "fit_quantiles",
            QUANTILE_RUNS,
            "{model}/{preset}",
            ["results/{dataset}/quantiles/{model}/{preset}/fit.json"],
        ),
        ("refit", [["", ""]] * bool(REFITS), "", []),
        ("refit_shells", [["", ""]] * bool(SHELLS), "", []),
        ("refit_spaces", [["", ""]] * bool(COMPARED), "", []),
        ("calibrate_intervals", [["", ""]], "", []),
        ("score_intervals", [["", ""]], "", []),
        ("score_extrapolation", [["", ""]], "", []),
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
