"""Rule fit_tuned: fit a model with the best parameters of each searched preset, on all rows of train."""

from softkin.files import read_json
from softkin.fitting import fit
from softkin.job import job
from softkin.models import MODELS

dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.model
files = zip(snakemake.input.parameters, snakemake.output.models, snakemake.output.records, strict=True)
with job(snakemake.log[0], f"fit {dataset} {model} tuned"):
    for parameters, fitted, record in files:
        found = read_json(parameters)
        fit(
            snakemake.input.table,
            spec=MODELS[model],
            params=found["params"],
            skip_constant=True,
            target_space=found["target_space"],
            base=snakemake.params.robot["base"],
            seed=snakemake.params.seed,
            threads=snakemake.threads,
            model=fitted,
            record=record,
            max_rows=snakemake.params.max_rows,
        )
