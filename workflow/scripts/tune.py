"""Rule tune: bring studies to their number of trials; write the best parameters and the tables of trials."""

from softkin.interface import OUTER, TUNED
from softkin.job import job
from softkin.models import MODELS
from softkin.tables.selection import INTERPOLATION
from softkin.tuning import TuningSettings
from softkin.tuning_models import Robot, SearchSettings, tune_table

given, output = snakemake.params, snakemake.output
dataset, model = snakemake.wildcards.dataset, snakemake.wildcards.model
tuning = given.tuning
n_trials = {TUNED: tuning["n_trials"], OUTER: tuning["n_outer_trials"]}
with job(snakemake.log[0], f"tune {dataset} {model}"):
    tune_table(
        snakemake.input.table,
        spec=MODELS[model],
        robot=Robot(**given.robot),
        settings=TuningSettings(tuning["n_trials"], tuning["n_folds"], tuning["max_rows"], given.seed),
        search=SearchSettings(
            {preset: n_trials[preset] for preset in given.presets},
            {TUNED, *given.presets, *([] if given.objective == INTERPOLATION else [OUTER])},
            tuning["max_markers"],
            tuning["core_shares"],
            given.target_spaces,
        ),
        studies=dict(zip(given.presets, given.studies, strict=True)),
        code=[*snakemake.input.code, *snakemake.input.model_code],
        threads=snakemake.threads,
        parameters=dict(zip(given.presets, output.parameters, strict=True)),
        trials=dict(zip(given.presets, output.trials, strict=True)),
    )
