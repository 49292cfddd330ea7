"""Rule intervals: put the intervals of every method around all models of a dataset, and choose one."""

from softkin.calibrating import calibrate
from softkin.choosing_intervals import choose, run_of_choice
from softkin.evidence import Evidences
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job

given, params = snakemake.input, snakemake.params
runs = [tuple(run) for run in params.runs]
methods = {name: INTERVAL_METHODS[name] for name in params.methods}
searched = [tuple(run) for run in params.searched]
with job(snakemake.log[0], f"intervals {snakemake.wildcards.dataset}"):
    evidences = Evidences(
        given.table,
        predictions=dict(zip(runs, given.predictions, strict=True)),
        quantiles=dict(zip(map(tuple, params.quantile_runs), given.quantiles, strict=True)),
        refits=given.refits[0] if given.refits else None,
        confidence_levels=params.confidence_levels,
        shells=given.shells[0] if given.shells else None,
    )
    calibrate(evidences, methods=methods, intervals=dict(zip(methods, snakemake.output.intervals, strict=True)))
    parameters = dict(zip(searched, given.parameters, strict=True))
    candidates = [run_of_choice(parameters, params.objective)] if searched else runs
    choose(evidences, methods=methods, runs=candidates, seed=params.seed, choice=snakemake.output.choice)
