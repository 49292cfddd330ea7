"""Rule fit_tuned: fit a model with its best parameters, on all rows of train."""

from softkin.files import read_json
from softkin.fitting import fit
from softkin.job import job
from softkin.models import MODELS

dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.model
with job(snakemake.log[0], f"fit {dataset} {model} tuned"):
    fit(
        snakemake.input.table,
        spec=MODELS[model],
        params=read_json(snakemake.input.parameters)["params"],
        skip_constant=True,
        seed=snakemake.params.seed,
        threads=snakemake.threads,
        model=snakemake.output.model,
        record=snakemake.output.record,
        max_rows=snakemake.params.max_rows,
    )
