"""Rule score_intervals: intervals -> interval metrics of one dataset."""

from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.scoring_intervals import score_intervals

dataset = snakemake.wildcards.dataset
methods = snakemake.params.methods
quantiles = zip(snakemake.params.quantile_runs, snakemake.input.quantiles, strict=True)
with job(snakemake.log[0], f"score intervals {dataset}"):
    score_intervals(
        snakemake.input.table,
        dataset=dataset,
        methods={method: INTERVAL_METHODS[method] for method in methods},
        intervals=dict(zip(methods, snakemake.input.intervals, strict=True)),
        quantiles={(model, preset): path for (model, preset), path in quantiles},
        confidence_levels=snakemake.params.confidence_levels,
        output=snakemake.output[0],
    )
