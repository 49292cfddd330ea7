# in:  the file of a dataset
# out: the tidy table (subset, u1.., m1_x.. in mm) and its description
rule prepare:
    input:
        raw="results/{dataset}/raw",
        order=order_table,
    output:
        table="results/{dataset}/table.parquet",
        description="results/{dataset}/dataset.json",
    log:
        "results/logs/prepare/{dataset}.log",
    priority: 50
    conda:
        SOFTWARE
    params:
        source=source,
        max_rows=config.get("max_rows_per_subset"),
        max_scored_rows=config.get("max_scored_rows"),
        code=prepare_code,
    script:
        "../scripts/prepare.py"
