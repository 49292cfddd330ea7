"""Rule quantiles: fit a learner of quantiles and predict them."""

from softkin.files import read_json
from softkin.job import job
from softkin.quantile_models import QUANTILE_MODELS
from softkin.quantiles import fit_quantiles

dataset, model, preset = (snakemake.wildcards[name] for name in ("dataset", "quantile_model", "preset"))
tuned = snakemake.input.parameters
with job(snakemake.log[0], f"quantiles {dataset} {model} {preset}"):
    fit_quantiles(
        snakemake.input.table,
        spec=QUANTILE_MODELS[model],
        params=read_json(tuned[0])["params"] if tuned else QUANTILE_MODELS[model].paper_params,
        confidence_levels=snakemake.params.confidence_levels,
        seed=snakemake.params.seed,
        threads=snakemake.threads,
        model=snakemake.output.model,
        quantiles=snakemake.output.quantiles,
        record=snakemake.output.record,
    )
