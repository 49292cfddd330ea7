"""Rule learning_curve: errors of the models of a dataset by the share of train that they are fitted to."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.manifest import files_of_runs
from softkin.core.runs import OUTER
from softkin.evaluation.learning_curve import FittedRun, learning_curve
from softkin.models import MODELS
from softkin.training.kinematic_model import recorded_settings

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
with job(snakemake.log[0], f"learning curve {dataset}", snakemake.output, snakemake.input, snakemake.params):
    records = files_of_runs(files.models, params.runs, "fit.json")
    predictions = files_of_runs(files.models, params.runs, "predictions.parquet")
    learning_curve(
        files.table,
        dataset=dataset,
        runs={
            run: FittedRun(
                MODELS[run.model],
                recorded_settings(read_json(records[run]), params.seed, snakemake.threads),
                predictions[run],
            )
            for run in records
            if run.model in params.shown and run.preset != OUTER
        },
        output=snakemake.output[0],
    )
