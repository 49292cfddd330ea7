"""Rule fit_paper: fit a model with the paper's settings."""

from softkin.core.job import job
from softkin.models import MODELS
from softkin.training.fit import fit
from softkin.training.kinematic_model import FitSettings

dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.model
with job(snakemake.log[0], f"fit {dataset} {model} paper"):
    fit(
        snakemake.input.table,
        spec=MODELS[model],
        settings=FitSettings(
            params={**MODELS[model].paper_params, **snakemake.params.overrides},
            skip_constant=False,  # the paper's models saw the coordinates that never move, and its R2 shows it
            seed=snakemake.params.seed,
            threads=snakemake.threads,
        ),
        model=snakemake.output.model,
        record=snakemake.output.record,
        max_rows=snakemake.params.max_rows,
    )
