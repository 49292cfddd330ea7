"""Rule retrieve: put the file of a dataset in place."""

import os

from softkin.core.credentials import with_credentials
from softkin.core.files import write_json
from softkin.core.job import job
from softkin.data.readers.simulated import RECIPE
from softkin.data.retrieve import retrieve, take_own_file, take_own_files

dataset = snakemake.wildcards.dataset
source = snakemake.params.source
place = {"dataset": dataset, "destination": snakemake.output[0]}
with job(snakemake.log[0], f"retrieve {dataset}", snakemake.output, params=snakemake.params):
    if "robot" in source:
        write_json(snakemake.output[0], {key: source[key] for key in RECIPE})
    elif "urls" in source:
        mirror = os.environ.get("SOFTKIN_DATA_MIRROR") or (
            snakemake.params.mirror and with_credentials(snakemake.params.mirror)
        )
        urls = [with_credentials(url) for url in source["urls"]]
        retrieve(**place, file=source["file"], urls=urls, sha256=source["sha256"], mirror=mirror)
    elif "files" in source:
        take_own_files(**place, entry=source)
    else:
        take_own_file(**place, file=source["file"], sha256=source.get("sha256"))
