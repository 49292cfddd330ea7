"""Rule refit: refit the cheap models of a dataset on parts of train."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.models import MODELS
from softkin.training.refit import RefittingSettings, refit

dataset = snakemake.wildcards.dataset
runs = [Run(*run) for run in snakemake.params.runs]
with job(snakemake.log[0], f"refit {dataset}"):
    refit(
        snakemake.input.table,
        dataset=dataset,
        specs={run: MODELS[run.model] for run in runs},
        records=dict(zip(runs, snakemake.input.records, strict=True)),
        settings=RefittingSettings(**snakemake.params.refitting, seed=snakemake.params.seed),
        threads=snakemake.threads,
        refits=snakemake.output[0],
    )
