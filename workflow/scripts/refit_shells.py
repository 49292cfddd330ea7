"""Rule refit_shells: refit a few models of a dataset on inner cores of train."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.models import MODELS
from softkin.training.refit_shells import ShellSettings, refit_shells
from softkin.training.selection import shell_runs

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
runs = [Run(*run) for run in params.runs]
parameters = dict(zip([Run(*run) for run in params.searched], files.parameters, strict=True))
with job(snakemake.log[0], f"refit shells {dataset}"):
    chosen = shell_runs(runs, parameters, params.objective, params.robust_models)
    refit_shells(
        files.table,
        dataset=dataset,
        specs={run: MODELS[run.model] for run in chosen},
        records=dict(zip(runs, files.records, strict=True)),
        max_fit_rows=params.max_fit_rows,
        settings=ShellSettings(
            **params.shells,
            standardised_norm=params.robot["standardised_norm"],
            seed=params.seed,
            threads=snakemake.threads,
        ),
        shells=snakemake.output[0],
    )
