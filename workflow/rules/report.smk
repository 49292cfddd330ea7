# in:  the tables; the description, data card and figures of each dataset; what each job took and recorded
# out: one page that tells the whole run, with everything inside
def timed_jobs():
    """(rule, model, preset), benchmark and record of each job of a dataset that is timed and leaves a record."""
    quantile_runs = QUANTILE_RUNS if asks_for("quantiles") else []
    timed = [
        ("tune", TUNED, every_run(), "{model}/{preset}/parameters.json"),
        ("fit_paper", PAPER, every_run(), "{model}/{preset}/fit.json"),
        ("fit_tuned", TUNED, every_run(), "{model}/{preset}/fit.json"),
        (
            "tune_quantiles",
            TUNED,
            quantile_runs,
            "quantiles/{model}/{preset}/parameters.json",
        ),
        ("quantiles", None, quantile_runs, "quantiles/{model}/{preset}/fit.json"),
    ]
    jobs = []
    for name, only, runs, record in timed:
        ending = "{model}.tsv" if only else "{model}/{preset}.tsv"
        for model, preset in runs:
            if only in (None, preset):
                files = [f"results/benchmarks/{name}/{{dataset}}/{ending}"]
                files.append(f"results/{{dataset}}/{record}")
                wildcards = {"model": model, "preset": preset}
                files = [expand(f, **wildcards, allow_missing=True)[0] for f in files]
                jobs.append([[name, model, preset], *files])
    return jobs


TIMED_JOBS = timed_jobs()
# Timed, one a dataset, and without a record.
TIMED_ONCE = ["refit"] * asks_for("folds", "resamples") + [
    "intervals",
    "score_intervals",
]


def jobs_of_report():
    """[rule, dataset, model, preset] in the order of the benchmarks: first those with a record, then the others."""
    recorded = [
        [name, dataset, model, preset]
        for dataset in config["datasets"]
        for (name, model, preset), _, _ in TIMED_JOBS
    ]
    once = [
        [name, dataset, "", ""] for dataset in config["datasets"] for name in TIMED_ONCE
    ]
    return recorded + once


def data_cards():
    """Those of every dataset, where the data are audited."""
    is_audited = workflow.is_rule("audit")
    return of_every_dataset("results/{dataset}/data_card.json") if is_audited else []


rule report:
    input:
        tables=expand("results/tables/{name}", name=TABLES),
        descriptions=of_every_dataset("results/{dataset}/dataset.json"),
        data_cards=data_cards(),
        figures=of_every_dataset("results/{dataset}/figures"),
        records=of_every_dataset([record for _, _, record in TIMED_JOBS]),
        benchmarks=of_every_dataset([file for _, file, _ in TIMED_JOBS])
        + of_every_dataset(
            [f"results/benchmarks/{n}/{{dataset}}.tsv" for n in TIMED_ONCE]
        ),
        citation=Path(workflow.basedir) / "CITATION.cff",
        code=package("tables/published.py", "tables/paper_layout.py"),
        page=[
            path
            for path in sorted((PACKAGE / "report").rglob("*.*"))
            if path.suffix != ".pyc"
        ],
    output:
        report(
            REPORT,
            caption="../report/page.rst",
            category="Overview",
            labels={"result": "report"},
        ),
    log:
        "results/logs/report.log",
    conda:
        SOFTWARE
    params:
        jobs=jobs_of_report(),
        config=config,
    script:
        "../scripts/report.py"
