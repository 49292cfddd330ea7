# Which jobs are timed, and where their times and records are: the report shows them.
def timed_jobs():
    """[rule, dataset, model] (empty: all of them), place and records of each job that is timed: its benchmark is
    results/benchmarks/<place>.tsv, its log results/logs/<place>.log."""
    per_model = {
        "fit_model": (
            "models",
            of_presets("fit.json") + of_searched("parameters.json"),
        ),
        "fit_ensemble": ("ensembles", of_ensemble("parameters.json")),
        "fit_quantiles": (
            "quantile_models",
            of_quantile_presets("fit.json")
            + of_quantile_presets("parameters.json", [TUNED]),
        ),
    }
    per_dataset = ["calibrate", "score", "draw_figures"]
    if REFITS or SHELLS or COMPARED:
        per_dataset.insert(0, "refit")
    jobs = []
    for dataset in config["datasets"]:
        for stage, (key, records) in per_model.items():
            for model in configured(key, dataset) * bool(records):
                names = {"dataset": dataset, "model": model}
                names |= {"ensemble": model, "quantile_model": model}
                jobs.append(
                    (
                        [stage, dataset, model],
                        f"{stage}/{dataset}/{model}",
                        expand(records, **names),
                    )
                )
        for stage in per_dataset:
            jobs.append(([stage, dataset, ""], f"{stage}/{dataset}", []))
    for dataset in RECORDED:
        jobs.append((["score_recorded", dataset, ""], f"score_recorded/{dataset}", []))
    for dataset in ORIENTED:
        jobs.append(
            (["fit_orientation", dataset, ""], f"fit_orientation/{dataset}", [])
        )
    for dataset in LEARNING:
        jobs.append((["learning_curve", dataset, ""], f"learning_curve/{dataset}", []))
    return jobs
