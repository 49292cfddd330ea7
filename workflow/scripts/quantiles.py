"""Rule quantiles: fit a learner of quantiles and predict them."""

from softkin.job import job
from softkin.quantile_models import QUANTILE_MODELS
from softkin.quantiles import fit_quantiles

dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.quantile_model
with job(snakemake.log[0], f"quantiles {dataset} {model}"):
    fit_quantiles(
        snakemake.input.table,
        spec=QUANTILE_MODELS[model],
        params=QUANTILE_MODELS[model].paper_params,
        confidence_levels=snakemake.params.confidence_levels,
        seed=snakemake.params.seed,
        threads=snakemake.threads,
        model=snakemake.output.model,
        quantiles=snakemake.output.quantiles,
        record=snakemake.output.record,
    )
