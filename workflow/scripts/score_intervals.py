"""Rule score_intervals: intervals -> interval metrics, conditional coverage and rates of alarm of one dataset."""

from softkin.choosing_intervals import shown_runs
from softkin.conditional_coverage import conditional_coverage
from softkin.datasets.table import read_subset
from softkin.evidence import Evidences
from softkin.interface import SUBSETS
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.regions import REGION_METHODS
from softkin.scoring_intervals import score_intervals
from softkin.scoring_regions import score_alarms

dataset, given, params = snakemake.wildcards.dataset, snakemake.input, snakemake.params
runs = [tuple(run) for run in params.runs]
intervals = dict(zip(params.methods, given.intervals, strict=True))
with job(snakemake.log[0], f"score intervals {dataset}"):
    evidences = Evidences(
        given.table,
        predictions=dict(zip(runs, given.predictions, strict=True)),
        quantiles=dict(zip(map(tuple, params.quantile_runs), given.quantiles, strict=True)),
        refits=given.refits[0] if given.refits else None,
        confidence_levels=params.confidence_levels,
        shells=given.shells[0] if given.shells else None,
    )
    score_intervals(
        given.table,
        dataset=dataset,
        methods={name: INTERVAL_METHODS[name] for name in params.methods},
        intervals=intervals,
        regions={name: REGION_METHODS[name] for name in params.regions},
        evidences=evidences,
        output=snakemake.output.metrics,
    )
    # Those made for commands outside train have nothing to show on test.
    inside = {name: path for name, path in intervals.items() if INTERVAL_METHODS[name].on != "shells"}
    conditional_coverage(
        given.table,
        dataset=dataset,
        intervals=inside,
        shown=shown_runs(given.choice),
        confidence_levels=params.confidence_levels,
        seed=params.seed,
        output=snakemake.output.conditional,
    )
    truth = {subset: read_subset(given.table, subset).positions for subset in SUBSETS}
    score_alarms(evidences, truth, dataset=dataset, seed=params.seed, output=snakemake.output.alarms)
