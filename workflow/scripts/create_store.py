"""Rule create_store: make the MLflow store, once, before any job logs to it."""

from softkin.core.credentials import with_credentials
from softkin.core.files import write_json
from softkin.core.job import job
from softkin.tracking.store import create_store

with job(snakemake.log[0], "create store", snakemake.output, params=snakemake.params):
    create_store(with_credentials(snakemake.params.tracking_uri))
    write_json(snakemake.output[0], {"tracking_uri": snakemake.params.tracking_uri})
