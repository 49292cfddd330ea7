"""Rule audit: tidy table -> data card."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.data.audit.data_card import audit

dataset = snakemake.wildcards.dataset
with job(snakemake.log[0], f"audit {dataset}", snakemake.output, snakemake.input, snakemake.params):
    audit(
        snakemake.input.table,
        dataset=dataset,
        title=snakemake.params.source["title"],
        position_unit=snakemake.params.source["position_unit"],
        data_card=snakemake.output.data_card,
        readable=snakemake.output.readable,
        description=read_json(snakemake.input.description),
        base=snakemake.params.source.get("base"),
    )
