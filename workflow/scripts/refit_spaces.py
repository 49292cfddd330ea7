"""Rule refit_spaces: fit every model in the target space that its search has not chosen."""

from softkin.core.job import job
from softkin.models import MODELS
from softkin.training.refit_spaces import refit_spaces

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
with job(snakemake.log[0], f"refit spaces {dataset}"):
    refit_spaces(
        files.table,
        specs={model: MODELS[model] for model in params.models},
        parameters=dict(zip(params.models, files.parameters, strict=True)),
        base=params.robot["base"],
        max_fit_rows=params.max_fit_rows,
        seed=params.seed,
        threads=snakemake.threads,
        predictions=snakemake.output[0],
    )
