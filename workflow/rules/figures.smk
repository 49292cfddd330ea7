# in:  the predictions, trials, intervals and scores of a dataset
# out: a folder of figures (PNG, SVG, and CSV of what they show) and an index of the runs that they show
rule draw_figures:
    input:
        table="results/{dataset}/table.parquet",
        description="results/{dataset}/dataset.json",
        data_card="results/{dataset}/data_card.json",
        models=model_manifests,
        intervals=INTERVAL_MANIFEST,
        point="results/{dataset}/point_metrics.csv",
        interval_metrics="results/{dataset}/interval_metrics.csv",
        choice="results/{dataset}/interval_choice.csv",
        conditional="results/{dataset}/conditional_coverage.csv",
        extrapolation="results/{dataset}/extrapolation_intervals.csv",
        target_spaces="results/{dataset}/target_spaces.csv",
    output:
        report(
            directory("results/{dataset}/figures"),
            patterns=["{figure}.png"],
            caption="../report/figure.rst",
            category="Figures",
            subcategory="{dataset}",
            labels={"figure": "{figure}"},
        ),
    log:
        "results/logs/draw_figures/{dataset}.log",
    benchmark:
        "results/benchmarks/draw_figures/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        runs=every_run,
        tuned=tuned_runs,
        methods=methods_of,
        source=source,
        code=code_of("draw_figures"),
    script:
        "../scripts/draw_figures.py"


# in:  the paper's printed cells beside ours, and learning curves
# out: a folder of the figures across datasets
rule draw_campaign_figures:
    input:
        published_comparison="results/tables/published_comparison.csv",
        learning_curve=["results/tables/learning_curve.csv"] * bool(LEARNING),
    output:
        directory("results/tables/figures"),
    log:
        "results/logs/draw_campaign_figures.log",
    benchmark:
        "results/benchmarks/draw_campaign_figures.tsv"
    conda:
        SOFTWARE
    threads: 1
    params:
        titles={name: config["sources"][name]["title"] for name in config["datasets"]},
        code=code_of("draw_campaign_figures"),
    script:
        "../scripts/draw_campaign_figures.py"
