# in:  the table of a dataset
# out: its data card: what was found in the data before anything is fitted to them, as JSON and as a page to read
rule audit:
    input:
        table="results/{dataset}/table.parquet",
        description="results/{dataset}/dataset.json",
        code=package(
            "findings.py",
            "rows.py",
            "smooth_fit.py",
            "target_spaces/base_frame.py",
            "target_spaces/constant_curvature.py",
            "datasets/table.py",
        ),
        checks=sorted((PACKAGE / "auditing").glob("*.py")),
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
    script:
        "../scripts/audit.py"
