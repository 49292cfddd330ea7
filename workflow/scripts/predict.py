"""Rule predict: predictions of every subset."""

from softkin.core.job import job
from softkin.models import MODELS
from softkin.training.predict import predict

of_presets = zip(snakemake.input.models, snakemake.output.predictions, snakemake.output.records, strict=True)
with job(snakemake.log[0], "predict {dataset} {model}".format(**snakemake.wildcards)):
    for model, predictions, record in of_presets:
        predict(
            snakemake.input.table,
            spec=MODELS[snakemake.wildcards.model],
            model=model,
            threads=snakemake.threads,
            predictions=predictions,
            record=record,
        )
