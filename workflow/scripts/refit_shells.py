"""Rule refit_shells: refit a few models of a dataset on inner cores of train."""

from softkin.choosing_intervals import shell_runs
from softkin.job import job
from softkin.models import MODELS
from softkin.refitting_shells import ShellSettings, refit_shells

given, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
runs = [tuple(run) for run in params.runs]
searched = [tuple(run) for run in params.searched]
with job(snakemake.log[0], f"refit shells {dataset}"):
    chosen = shell_runs(runs, dict(zip(searched, given.parameters, strict=True)), params.objective)
    refit_shells(
        given.table,
        dataset=dataset,
        standardised="split" in params.source,
        specs={run: MODELS[run[0]] for run in chosen},
        records=dict(zip(runs, given.records, strict=True)),
        max_fit_rows=params.max_fit_rows,
        settings=ShellSettings(**params.shells, seed=params.seed),
        threads=snakemake.threads,
        shells=snakemake.output[0],
    )
