include: "orientation.smk"


for group in GROUPS:

    # in:  stored outputs of all models of a dataset, the truth on validation, the fitted models, names of the robot's columns;
    #      the model of the tip's orientation, where there is one
    # out: the intervals of every method around all of them, on test and extrapolation; which method is chosen; and one file
    #      that predicts with the chosen model and method, with intervals, regions and p-values, at any command
    rule:
        name:
            name_of("calibrate", group)
        input:
            **STORED_OUTPUTS,
            table="results/{dataset}/table.parquet",
            description="results/{dataset}/dataset.json",
            orientation=orientation_model,
        output:
            intervals=of_methods(group),
            manifest=INTERVAL_MANIFEST,
            choice="results/{dataset}/interval_choice.csv",
            calibrated_model=CALIBRATED_MODEL,
        log:
            "results/logs/calibrate/{dataset}.log",
        benchmark:
            "results/benchmarks/calibrate/{dataset}.tsv"
        wildcard_constraints:
            dataset=datasets_of(group),
        priority: 30
        conda:
            SOFTWARE
        threads: 1
        params:
            **interval_params(),
            objective=config["objective"],
            regime=config["regime"],
            code=code_of("calibrate", *interval_modules(group.interval_methods)),
        script:
            "../scripts/calibrate.py"
