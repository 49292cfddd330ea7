"""Rule score_intervals: intervals -> interval metrics, conditional coverage and rates of alarm of one dataset."""

from softkin.core.job import job
from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset
from softkin.evaluation.conditional_coverage import conditional_coverage
from softkin.evaluation.score_intervals import score_intervals
from softkin.evaluation.score_regions import score_alarms
from softkin.uncertainty.choose import shown_runs
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.stored_outputs import stored_outputs

dataset, params, table = snakemake.wildcards.dataset, snakemake.params, snakemake.input.table
methods = {name: INTERVAL_METHODS[name] for name in params.methods}
intervals = dict(zip(methods, snakemake.input.intervals, strict=True))
with job(snakemake.log[0], f"score intervals {dataset}"):
    outputs = stored_outputs(snakemake.input, params)
    score_intervals(
        table,
        dataset=dataset,
        methods=methods,
        intervals=intervals,
        regions={name: REGION_METHODS[name] for name in params.regions},
        outputs=outputs,
        output=snakemake.output.metrics,
    )
    # Methods for extrapolation have nothing to show on test.
    in_domain = {name: intervals[name] for name in methods if not methods[name].calibrated_on.is_for_extrapolation}
    conditional_coverage(
        table,
        dataset=dataset,
        intervals=in_domain,
        shown=shown_runs(snakemake.input.choice),
        confidence_levels=params.confidence_levels,
        seed=params.seed,
        output=snakemake.output.conditional,
    )
    truth = {subset: read_subset(table, subset).positions for subset in SUBSETS}
    score_alarms(outputs, truth, dataset=dataset, seed=params.seed, output=snakemake.output.alarms)
