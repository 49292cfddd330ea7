"""Rule prepare: the file of a dataset -> tidy table in mm."""

from softkin.core.job import job
from softkin.data.audit.cleaning import cleaned
from softkin.data.prepare import prepare
from softkin.data.scored_rows import KeptRows

dataset = snakemake.wildcards.dataset
with job(snakemake.log[0], f"prepare {dataset}", snakemake.output, snakemake.input, snakemake.params):
    prepare(
        snakemake.input.raw,
        dataset=dataset,
        source=snakemake.params.source,
        table=snakemake.output.table,
        description=snakemake.output.description,
        order_table=next(iter(snakemake.input.order), None),
        kept=KeptRows(snakemake.params.max_rows, snakemake.params.max_scored_rows),
        clean=cleaned if snakemake.params.source.get("clean") else None,
    )
