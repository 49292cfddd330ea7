"""Rule predict: predictions of every subset."""

from softkin.fitting import predict
from softkin.job import job

with job(snakemake.log[0], "predict {dataset} {model} {preset}".format(**snakemake.wildcards)):
    predict(
        snakemake.input.table,
        model=snakemake.input.model,
        threads=snakemake.threads,
        predictions=snakemake.output.predictions,
        record=snakemake.output.record,
    )
