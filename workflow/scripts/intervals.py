"""Rule intervals: choose a method for a dataset, and put the intervals of every method around all its models."""

from softkin.calibrating import calibrate
from softkin.choosing_intervals import choose, deployed_choice, run_of_choice
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
    parameters = dict(zip(searched, given.parameters, strict=True))
    candidates = [run_of_choice(parameters, params.objective)] if searched else runs
    choice = snakemake.output.choice
    choose(evidences, methods=methods, runs=candidates, seed=params.seed, regime=params.regime, choice=choice)
    best = deployed_choice(choice)
    inside = {} if best is None else {(best["model"], best["preset"]): methods[best["interval_method"]]}
    intervals = dict(zip(methods, snakemake.output.intervals, strict=True))
    calibrate(evidences, methods=methods, inside=inside, intervals=intervals)
