"""Rule tune_quantiles: bring the study of a quantile regressor to its number of trials."""

from softkin.core.job import job
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.study import StudyFile, TuningSettings
from softkin.training.tune_quantiles import tune_quantiles

dataset, model, params = snakemake.wildcards.dataset, snakemake.wildcards.quantile_model, snakemake.params
with job(snakemake.log[0], f"tune quantiles {dataset} {model}"):
    tune_quantiles(
        snakemake.input.table,
        spec=QUANTILE_MODELS[model],
        settings=TuningSettings(params.n_trials, params.n_folds, params.max_rows, params.seed),
        file=StudyFile(params.study, [*snakemake.input.code, *snakemake.input.quantile_code]),
        threads=snakemake.threads,
        parameters=snakemake.output.parameters,
        trials=snakemake.output.trials,
    )
