# in:  stored outputs of all models of a dataset, and the truth on validation
# out: the intervals of every method around all of them, on test and extrapolation; and which method is chosen
# One job for all methods: starting one costs more than calibrating.
rule calibrate_intervals:
    input:
        unpack(stored_outputs),
        table="results/{dataset}/table.parquet",
        parameters=run_files("parameters.json", SEARCHED),
        code=code_of("calibrate_intervals"),
        interval_code=interval_code(),
    output:
        intervals=expand(
            "results/{{dataset}}/intervals/{method}.parquet",
            method=config["interval_methods"],
        ),
        choice="results/{dataset}/interval_choice.csv",
    log:
        "results/logs/calibrate_intervals/{dataset}.log",
    benchmark:
        "results/benchmarks/calibrate_intervals/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        **interval_params(),
        searched=searched_runs(),
        objective=config["objective"],
        regime=config["regime"],
    script:
        "../scripts/calibrate_intervals.py"


# in:  which model and method a dataset gets, the fitted models, the rows of train and validation
# out: one file that predicts, with intervals, regions and p-values, at any command
rule build_calibrated_model:
    input:
        table="results/{dataset}/table.parquet",
        choice="results/{dataset}/interval_choice.csv",
        models=run_files("model.joblib"),
        shells=SHELLS,
        code=code_of("build_calibrated_model"),
    output:
        "results/{dataset}/calibrated_model.joblib",
    log:
        "results/logs/build_calibrated_model/{dataset}.log",
    benchmark:
        "results/benchmarks/build_calibrated_model/{dataset}.tsv"
    priority: 30
    conda:
        SOFTWARE
    threads: 1
    params:
        runs=every_run(),
    script:
        "../scripts/build_calibrated_model.py"
