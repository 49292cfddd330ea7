if RECORDED:

    # in:  the table of a recorded dataset, what each model was fitted with, and which run is deployed
    # out: the deployed run's scores in time, with its memory and without: on the published split, in sessions never seen,
    #      before and after recalibration on a few poses, and later in the recording
    rule score_recorded:
        input:
            table="results/{dataset}/table.parquet",
            models=model_manifests,
            choice="results/{dataset}/interval_choice.csv",
        output:
            "results/{dataset}/recorded.csv",
        log:
            "results/logs/score_recorded/{dataset}.log",
        benchmark:
            "results/benchmarks/score_recorded/{dataset}.tsv"
        priority: 30
        conda:
            SOFTWARE
        threads: 1
        params:
            runs=every_run,
            max_fit_rows=config["max_fit_rows"],
            confidence_levels=config["confidence_levels"],
            seed=config["seed"],
            code=code_of("score_recorded"),
        script:
            "../scripts/score_recorded.py"
