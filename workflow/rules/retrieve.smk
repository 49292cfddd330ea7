# in:  nothing (the mirror or the internet)
# out: the published file of a dataset, hash checked
rule retrieve:
    output:
        "results/{dataset}/raw.json",
    log:
        "results/logs/retrieve/{dataset}.log",
    priority: 50
    conda:
        SOFTWARE
    params:
        source=source,
        mirror=config.get("data_mirror"),
    script:
        "../scripts/retrieve.py"
