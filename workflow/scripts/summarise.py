"""Rule summarise: what a run says, in the form that campaigns are compared by."""

from softkin.campaigns.summary import Layout, summarise
from softkin.core.job import job

files, params = snakemake.input, snakemake.params
with job(snakemake.log[0], "summarise", snakemake.output, snakemake.input, snakemake.params):
    summarise(
        params.config,
        Layout(**params.layout),
        point=files.point,
        intervals=files.intervals,
        choice=files.choice,
        output=snakemake.output.summary,
        rows=snakemake.output.rows,
    )
