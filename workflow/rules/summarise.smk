# in:  the tables; the data of each dataset, and the predictions and intervals of its deployed model (among its scores'
#      inputs, so that they are there)
# out: what a campaign is compared by: the headline metrics, and errors, widths and coverage of each row
rule summarise:
    input:
        point="results/tables/point_metrics.csv",
        intervals="results/tables/interval_metrics.csv",
        choice="results/tables/interval_choice.csv",
        table=of_every_dataset("results/{dataset}/table.parquet"),
        description=of_every_dataset("results/{dataset}/dataset.json"),
        data_card=of_every_dataset("results/{dataset}/data_card.json"),
    output:
        summary="results/tables/summary.json",
        rows="results/tables/summary_rows.parquet",
    log:
        "results/logs/summarise.log",
    benchmark:
        "results/benchmarks/summarise.tsv"
    conda:
        SOFTWARE
    params:
        config=config,
        layout={
            "table": "results/{dataset}/table.parquet",
            "description": "results/{dataset}/dataset.json",
            "data_card": "results/{dataset}/data_card.json",
            "predictions": "results/{dataset}/{model}/{preset}/predictions.parquet",
            "intervals": "results/{dataset}/intervals/{method}.parquet",
        },
        code=code_of("summarise"),
    script:
        "../scripts/summarise.py"
