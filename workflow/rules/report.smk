# in:  the tables; the description, data card and figures of each dataset; what each job took and recorded
# out: one page on the whole run, with its figures and tables in it
rule build_report:
    input:
        tables=expand("results/tables/{name}", name=TABLES),
        descriptions=of_every_dataset("results/{dataset}/dataset.json"),
        data_cards=of_every_dataset("results/{dataset}/data_card.json"),
        card_pages=of_every_dataset("results/{dataset}/data_card.md"),
        figures=of_every_dataset("results/{dataset}/figures"),
        campaign_figures="results/tables/figures",
        benchmarks=[f"results/benchmarks/{place}.tsv" for _, place, _ in timed_jobs()],
    output:
        report(
            REPORT,
            caption="../report/page.rst",
            category="Overview",
            labels={"result": "report"},
        ),
    log:
        "results/logs/build_report.log",
    benchmark:
        "results/benchmarks/build_report.tsv"
    conda:
        SOFTWARE
    params:
        jobs=timed_jobs(),
        config=config,
        code=code_of("build_report"),
        templates=content("src/softkin/reporting/page/templates/**/*.*"),
        citation=content("CITATION.cff"),
    script:
        "../scripts/build_report.py"
