"""Rule calibrate_intervals: choose a method for a dataset, and put the intervals of every method around its models."""

from softkin.core.job import job
from softkin.core.runs import Run
from softkin.training.selection import run_of_choice
from softkin.uncertainty.calibrate import calibrate
from softkin.uncertainty.choose import choose, deployed_choice
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.stored_outputs import stored_outputs

params = snakemake.params
methods = {name: INTERVAL_METHODS[name] for name in params.methods}
searched = [Run(*run) for run in params.searched]
with job(snakemake.log[0], f"calibrate intervals {snakemake.wildcards.dataset}"):
    outputs = stored_outputs(snakemake.input, params)
    parameters = dict(zip(searched, snakemake.input.parameters, strict=True))
    candidates = [run_of_choice(parameters, params.objective)] if searched else [Run(*run) for run in params.runs]
    choice = snakemake.output.choice
    choose(outputs, methods=methods, runs=candidates, seed=params.seed, regime=params.regime, choice=choice)
    best = deployed_choice(choice)
    in_domain = {} if best is None else {Run(best["model"], best["preset"]): methods[best["interval_method"]]}
    intervals = dict(zip(methods, snakemake.output.intervals, strict=True))
    calibrate(outputs, methods=methods, in_domain=in_domain, intervals=intervals)
