# in:  the intervals of a dataset, what was chosen, its conditional coverage
# out: a folder of figures (PNG, SVG, and CSV of what they show) and an index of the runs that they show
rule figures:
    input:
        table="results/{dataset}/table.parquet",
        description="results/{dataset}/dataset.json",
        data_card="results/{dataset}/data_card.json",
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        choice="results/{dataset}/interval_choice.csv",
        conditional="results/{dataset}/conditional_coverage.csv",
        code=package("bounds.py", "figures/drawing.py", "figures/style.py"),
        figure_code=figure_code(),
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
        "results/logs/figures/{dataset}.log",
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        methods=config["interval_methods"],
    script:
        "../scripts/figures.py"
