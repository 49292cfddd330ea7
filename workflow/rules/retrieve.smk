# in:  nothing (the mirror or the internet), or a local file
# out: the file of a dataset as it came, hash checked where a hash is registered
rule retrieve:
    input:
        own_file,
    output:
        "results/{dataset}/raw",
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
