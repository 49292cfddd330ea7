"""Rule score_outside: intervals outside train, each beside the oracle -> extrapolation_intervals.csv of one dataset."""

from softkin.choosing_intervals import shell_runs
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.outside import OUTSIDE_METHODS
from softkin.scoring_outside import score_outside

dataset, given, params = snakemake.wildcards.dataset, snakemake.input, snakemake.params
runs = [tuple(run) for run in params.runs]
searched = [tuple(run) for run in params.searched]
with job(snakemake.log[0], f"score outside {dataset}"):
    score_outside(
        given.table,
        dataset=dataset,
        standardised="split" in params.source,
        methods={name: INTERVAL_METHODS[name] for name in params.methods},
        intervals=dict(zip(params.methods, given.intervals, strict=True)),
        outside_methods=OUTSIDE_METHODS,
        predictions=dict(zip(runs, given.predictions, strict=True)),
        runs=shell_runs(runs, dict(zip(searched, given.parameters, strict=True)), params.objective),
        confidence_levels=params.confidence_levels,
        seed=params.seed,
        output=snakemake.output[0],
    )
