"""Rule retrieve: put the published file of a dataset in place."""

import os

from softkin.datasets.retrieving import retrieve
from softkin.job import job

dataset = snakemake.wildcards.dataset
source = snakemake.params.source
with job(snakemake.log[0], f"retrieve {dataset}"):
    retrieve(
        dataset=dataset,
        file=source["file"],
        urls=source["urls"],
        sha256=source["sha256"],
        destination=snakemake.output[0],
        mirror=os.environ.get("SOFTKIN_DATA_MIRROR") or snakemake.params.mirror,
    )
