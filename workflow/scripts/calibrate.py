"""Rule calibrate: put the intervals of every method around a dataset's models; choose one, with its model a file."""

from pathlib import Path

from softkin.core.job import job
from softkin.core.manifest import files_of_runs, write_manifest
from softkin.core.runs import Run
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.training.selection import deployable_runs
from softkin.uncertainty.build_calibrated_model import build_calibrated_model
from softkin.uncertainty.calibrate import calibrate
from softkin.uncertainty.choose import choose, deployed_choice
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.promise import promised_methods
from softkin.uncertainty.stored_outputs import stored_outputs

files, params, output, dataset = snakemake.input, snakemake.params, snakemake.output, snakemake.wildcards.dataset
methods = {name: INTERVAL_METHODS[name] for name in params.methods}
models = files_of_runs(files.models, params.runs, "model.joblib")
parameters = files_of_runs(files.models, params.searched, "parameters.json")
intervals = {name: str(Path(output.manifest).with_name(f"{name}.parquet")) for name in methods}
written = list(dict.fromkeys([*output, *intervals.values()]))
# Where the calibrated model is not asked for, that of an earlier run stays, and can be loaded.
kept = [] if output.calibrated_model else [f"results/{dataset}/calibrated_model.joblib"]
with job(snakemake.log[0], f"calibrate {dataset}", written, snakemake.input, snakemake.params, kept):
    outputs = stored_outputs(files, params)
    candidates = deployable_runs(list(models), parameters, params.objective)
    choose(outputs, methods=methods, runs=candidates, seed=params.seed, regime=params.regime, choice=output.choice)
    best = deployed_choice(output.choice)
    calibrating = promised_methods(methods, outputs.promise)
    in_domain = {} if best is None else {Run(best["model"], best["preset"]): calibrating[best["interval_method"]]}
    calibrate(
        outputs,
        methods=calibrating,
        in_domain=in_domain,
        intervals=intervals,
    )
    for calibrated_model in output.calibrated_model:
        build_calibrated_model(
            outputs,
            description=files.description,
            choice=output.choice,
            specs=MODELS | ENSEMBLES,
            methods=INTERVAL_METHODS,
            models=models,
            orientation=next(iter(files.orientation), None),
            output=calibrated_model,
        )
    write_manifest(output.manifest, intervals.values())
