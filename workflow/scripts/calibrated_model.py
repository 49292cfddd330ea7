"""Rule calibrated_model: the chosen model and method of a dataset as one file to be used elsewhere."""

from softkin.calibrated_model import bundle
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.models import MODELS

dataset = snakemake.wildcards.dataset
runs = [tuple(run) for run in snakemake.params.runs]
with job(snakemake.log[0], f"calibrated model {dataset}"):
    bundle(
        snakemake.input.table,
        dataset=dataset,
        choice=snakemake.input.choice,
        specs=MODELS,
        methods=INTERVAL_METHODS,
        models=dict(zip(runs, snakemake.input.models, strict=True)),
        shells=next(iter(snakemake.input.shells), None),
        output=snakemake.output[0],
    )
