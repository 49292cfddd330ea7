"""Rule tune: bring studies to their number of trials; write the best parameters and the tables of trials."""

from softkin.core.job import job
from softkin.core.runs import OUTER, TUNED
from softkin.models import MODELS
from softkin.training.selection import INTERPOLATION
from softkin.training.study import TuningSettings
from softkin.training.tune import PresetFiles, Robot, SearchSettings, tune_table

params, output = snakemake.params, snakemake.output
dataset, model, tuning = snakemake.wildcards.dataset, snakemake.wildcards.model, snakemake.params.tuning
n_trials = {TUNED: tuning["n_trials"], OUTER: tuning["n_outer_trials"]}
of_presets = map(PresetFiles, params.studies, output.parameters, output.trials)
with job(snakemake.log[0], f"tune {dataset} {model}"):
    tune_table(
        snakemake.input.table,
        spec=MODELS[model],
        robot=Robot(**params.robot),
        settings=TuningSettings(tuning["n_trials"], tuning["n_folds"], tuning["max_rows"], params.seed),
        search=SearchSettings(
            {preset: n_trials[preset] for preset in params.presets},
            {TUNED, *params.presets, *([] if params.objective == INTERPOLATION else [OUTER])},
            tuning["max_markers"],
            tuning["core_shares"],
            params.target_spaces,
        ),
        files=dict(zip(params.presets, of_presets, strict=True)),
        code=[*snakemake.input.code, *snakemake.input.model_code],
        threads=snakemake.threads,
    )
