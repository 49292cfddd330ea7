# in:  the table of a dataset
# out: its data card: the findings of all checks, before anything is fitted to the data; as JSON and as a page to read
rule audit:
    input:
        table="results/{dataset}/table.parquet",
        description="results/{dataset}/dataset.json",
    output:
        data_card="results/{dataset}/data_card.json",
        readable="results/{dataset}/data_card.md",
    log:
        "results/logs/audit/{dataset}.log",
    priority: 40
    conda:
        SOFTWARE
    threads: 1
    params:
        source=source,
        code=code_of("audit"),
    script:
        "../scripts/audit.py"
