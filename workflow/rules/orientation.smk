if ORIENTED:

    # in:  the table of a dataset whose entry names the orientation of its tip, and the mean rotation of train
    # out: a model of it, chosen and fitted on train and calibrated on validation, and its scores
    rule fit_orientation:
        input:
            table="results/{dataset}/table.parquet",
            description="results/{dataset}/dataset.json",
        output:
            model="results/{dataset}/orientation.joblib",
            scores="results/{dataset}/orientation.csv",
        log:
            "results/logs/fit_orientation/{dataset}.log",
        benchmark:
            "results/benchmarks/fit_orientation/{dataset}.tsv"
        priority: 30
        conda:
            SOFTWARE
        threads: 1
        params:
            confidence_levels=config["confidence_levels"],
            seed=config["seed"],
            code=code_of("fit_orientation"),
        script:
            "../scripts/fit_orientation.py"
