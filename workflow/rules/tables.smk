# in:  the scores of all datasets, the tuned parameters, the paper's printed cells
# out: results/tables: ours, ours beside the paper's, the chosen models, the headline
rule build_tables:
    input:
        point=of_every_dataset("results/{dataset}/point_metrics.csv"),
        markers=of_every_dataset("results/{dataset}/marker_errors.csv"),
        intervals=of_every_dataset("results/{dataset}/interval_metrics.csv"),
        choice=of_every_dataset("results/{dataset}/interval_choice.csv"),
        conditional=of_every_dataset("results/{dataset}/conditional_coverage.csv"),
        alarms=of_every_dataset("results/{dataset}/alarm_rates.csv"),
        extrapolation=of_every_dataset("results/{dataset}/extrapolation_intervals.csv"),
        spaces=of_every_dataset("results/{dataset}/target_spaces.csv"),
        left_out=of_every_dataset("results/{dataset}/left_out.csv"),
        description=of_every_dataset("results/{dataset}/dataset.json"),
        data_card=of_every_dataset("results/{dataset}/data_card.json"),
        models=[file for name in config["datasets"] for file in manifests_of(name)],
        recorded=expand("results/{dataset}/recorded.csv", dataset=RECORDED),
        learning=expand("results/{dataset}/learning_curve.csv", dataset=LEARNING),
        orientation=expand("results/{dataset}/orientation.csv", dataset=ORIENTED),
    output:
        headline=report(
            HEADLINE,
            caption="../report/headline.rst",
            category="Overview",
            labels={"result": "headline"},
        ),
        paper=[
            report(
                f"results/tables/{name}",
                caption="../report/paper_tables.rst",
                category="Tables",
                labels={"table": name},
            )
            for name in PAPER_TABLES
        ],
        tables=[
            report(
                f"results/tables/{name}",
                caption="../report/table.rst",
                category="Tables",
                labels={"table": name},
            )
            for name in TABLES
        ],
    log:
        "results/logs/build_tables.log",
    benchmark:
        "results/benchmarks/build_tables.tsv"
    conda:
        SOFTWARE
    params:
        searched={name: searched_of(name) for name in config["datasets"]},
        objective=config["objective"],
        caution=config.get("caution"),
        sources={name: config["sources"][name] for name in config["datasets"]},
        code=code_of("build_tables"),
        published=content("resources/published/*.csv"),
    script:
        "../scripts/build_tables.py"
