"""Rule fit_quantiles: fit a quantile regressor and predict quantiles."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.fit_quantiles import QuantileModel, fit_quantiles

dataset, model, preset = (snakemake.wildcards[name] for name in ("dataset", "quantile_model", "preset"))
tuned, params, spec = snakemake.input.parameters, snakemake.params, QUANTILE_MODELS[model]
with job(snakemake.log[0], f"fit quantiles {dataset} {model} {preset}"):
    settings = read_json(tuned[0])["params"] if tuned else spec.paper_params
    fit_quantiles(
        snakemake.input.table,
        regressor=QuantileModel(spec, settings, params.confidence_levels, params.seed, snakemake.threads),
        model=snakemake.output.model,
        quantiles=snakemake.output.quantiles,
        record=snakemake.output.record,
    )
