"""Rule refit: refit models of a dataset on folds and bootstrap samples, on inner cores, in the other target space."""

from softkin.core.job import job
from softkin.core.manifest import files_of_runs
from softkin.core.runs import OUTER, Run
from softkin.models import MODELS
from softkin.training.members import all_members, members_of_runs
from softkin.training.refit import RefittingSettings, refit
from softkin.training.refit_shells import ShellSettings, refit_shells
from softkin.training.refit_spaces import refit_spaces
from softkin.training.selection import runs_to_refit, shell_runs

files, params, output, threads = snakemake.input, snakemake.params, snakemake.output, snakemake.threads
dataset = snakemake.wildcards.dataset
records = files_of_runs(files.models, params.runs, "fit.json")
parameters = files_of_runs(files.models, params.searched, "parameters.json")


def fitted(runs):
    """What is fitted for these runs, and of which fits each is the mean."""
    weights = members_of_runs(runs, records)
    return {"specs": {run: MODELS[run.model] for run in all_members(weights)}, "weights": weights}


with job(snakemake.log[0], f"refit {dataset}", snakemake.output, snakemake.input, snakemake.params):
    if output.refits:
        refit(
            files.table,
            dataset=dataset,
            **fitted(runs_to_refit(list(records), parameters, params.objective, params.cheap_models)),
            records=records,
            settings=RefittingSettings(**params.refitting, seed=params.seed),
            threads=threads,
            refits=output.refits[0],
        )
    if output.shells:
        refit_shells(
            files.table,
            dataset=dataset,
            **fitted(shell_runs(list(records), parameters, params.objective, params.robust_models)),
            records=records,
            max_fit_rows=params.max_fit_rows,
            settings=ShellSettings(
                **params.shell_settings,
                standardised_norm=params.robot["standardised_norm"],
                seed=params.seed,
                threads=threads,
            ),
            shells=output.shells[0],
        )
    if output.spaces:
        refit_spaces(
            files.table,
            specs={model: MODELS[model] for model in params.compared},
            parameters={model: parameters[Run(model, OUTER)] for model in params.compared},
            base=params.robot["base"],
            max_fit_rows=params.max_fit_rows,
            seed=params.seed,
            threads=threads,
            predictions=output.spaces[0],
        )
