"""Rule tune: bring a study to its number of trials; write the best parameters and the table of trials."""

from softkin.job import job
from softkin.models import MODELS
from softkin.tuning import TuningSettings, tune_table

given = snakemake.params
dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.model
with job(snakemake.log[0], f"tune {dataset} {model}"):
    tune_table(
        snakemake.input.table,
        spec=MODELS[model],
        settings=TuningSettings(given.n_trials, given.n_folds, given.max_rows, given.seed),
        study_file=given.study,
        code=[*snakemake.input.code, *snakemake.input.model_code],
        threads=snakemake.threads,
        parameters=snakemake.output.parameters,
        trials=snakemake.output.trials,
    )
