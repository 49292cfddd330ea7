# Which jobs are timed, and where their times and records are: the report shows them.
def records_of(group):
    """Jobs of one model of a dataset: the key of the configuration that names it, and their records, in a group."""
    quantile_presets = has_quantiles(group)
    tuned = [preset for preset in quantile_presets if preset == TUNED]
    return {
        "fit_model": (
            "models",
            of_presets("fit.json", group.presets)
            + of_presets("parameters.json", searched(group.presets)),
        ),
        "fit_ensemble": ("ensembles", of_ensemble("parameters.json", group.presets)),
        "fit_quantiles": (
            "quantile_models",
            of_quantile_presets("fit.json", quantile_presets)
            + of_quantile_presets("parameters.json", tuned),
        ),
    }


def timed_jobs():
    """[rule, dataset, model] (empty: all of them), place and records of each job that is timed: its benchmark is
    results/benchmarks/<place>.tsv, its log results/logs/<place>.log."""
    jobs = []
    for dataset in config["datasets"]:
        group = group_of(dataset)
        per_dataset = ["calibrate", "score", "draw_figures"]
        if any(refit_files(group).values()):
            per_dataset.insert(0, "refit")
        for stage, (key, records) in records_of(group).items():
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
