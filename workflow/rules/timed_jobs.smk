# Which jobs are timed, and where their times and records are: the report shows them.
def timed_jobs():
    """[rule, dataset, model] (empty: all of them), benchmark and records of each job that is timed."""
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
                benchmark = f"results/benchmarks/{stage}/{dataset}/{model}.tsv"
                names = {"dataset": dataset, "model": model}
                names |= {"ensemble": model, "quantile_model": model}
                jobs.append(
                    ([stage, dataset, model], benchmark, expand(records, **names))
                )
        for stage in per_dataset:
            jobs.append(
                ([stage, dataset, ""], f"results/benchmarks/{stage}/{dataset}.tsv", [])
            )
    for dataset in RECORDED:
        benchmark = f"results/benchmarks/score_recorded/{dataset}.tsv"
        jobs.append((["score_recorded", dataset, ""], benchmark, []))
    for dataset in LEARNING:
        benchmark = f"results/benchmarks/learning_curve/{dataset}.tsv"
        jobs.append((["learning_curve", dataset, ""], benchmark, []))
    return jobs
