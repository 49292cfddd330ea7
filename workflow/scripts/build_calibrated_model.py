"""Rule build_calibrated_model: the deployed model and interval method of a dataset as one file."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.models import MODELS
from softkin.uncertainty.calibrated_model import build_calibrated_model
from softkin.uncertainty.intervals import INTERVAL_METHODS

dataset = snakemake.wildcards.dataset
runs = [Run(*run) for run in snakemake.params.runs]
with job(snakemake.log[0], f"calibrated model {dataset}"):
    build_calibrated_model(
        snakemake.input.table,
        dataset=dataset,
        choice=snakemake.input.choice,
        specs=MODELS,
        methods=INTERVAL_METHODS,
        models=dict(zip(runs, snakemake.input.models, strict=True)),
        shells=next(iter(snakemake.input.shells), None),
        output=snakemake.output[0],
    )
