"""Rule intervals: put the intervals of one method around all models of a dataset."""

from softkin.calibrating import calibrate
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job

dataset, method = snakemake.wildcards.dataset, snakemake.wildcards.interval_method
sources = zip(snakemake.params.runs, snakemake.input.sources, strict=True)
with job(snakemake.log[0], f"intervals {dataset} {method}"):
    calibrate(
        snakemake.input.table,
        method=INTERVAL_METHODS[method],
        sources={(model, preset): source for (model, preset), source in sources},
        confidence_levels=snakemake.params.confidence_levels,
        intervals=snakemake.output[0],
    )
