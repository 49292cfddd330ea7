"""Rule tune_quantiles: bring the study of a learner of quantiles to its number of trials."""

from softkin.job import job
from softkin.quantile_models import QUANTILE_MODELS
from softkin.tuning import TuningSettings
from softkin.tuning_quantiles import tune_quantiles

dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.quantile_model
given = snakemake.params
with job(snakemake.log[0], f"tune quantiles {dataset} {model}"):
    tune_quantiles(
        snakemake.input.table,
        spec=QUANTILE_MODELS[model],
        settings=TuningSettings(given.n_trials, given.n_folds, given.max_rows, given.seed),
        study_file=given.study,
        code=[*snakemake.input.code, *snakemake.input.quantile_code],
        threads=snakemake.threads,
        parameters=snakemake.output.parameters,
        trials=snakemake.output.trials,
    )
