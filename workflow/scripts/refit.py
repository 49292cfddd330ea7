"""Rule refit: refit the cheap models of a dataset on parts of train."""

from softkin.job import job
from softkin.models import MODELS
from softkin.refitting import RefittingSettings, refit

dataset = snakemake.wildcards.dataset
runs = [tuple(run) for run in snakemake.params.runs]
with job(snakemake.log[0], f"refit {dataset}"):
    refit(
        snakemake.input.table,
        dataset=dataset,
        specs={run: MODELS[run[0]] for run in runs},
        records=dict(zip(runs, snakemake.input.records, strict=True)),
        settings=RefittingSettings(**snakemake.params.refitting, seed=snakemake.params.seed),
        threads=snakemake.threads,
        refits=snakemake.output[0],
    )
