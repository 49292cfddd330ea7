"""Rule fit_model: bring the studies of a model to their number of trials; fit and predict by every preset."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.manifest import write_manifest
from softkin.core.runs import INTERPOLATION, OUTER, PAPER, SEARCHED, TUNED
from softkin.models import MODELS
from softkin.training.fit import FitFiles, fit_each
from softkin.training.held_out import Robot
from softkin.training.kinematic_model import FitSettings, searched_settings
from softkin.training.study import TuningSettings
from softkin.training.tune import PresetFiles, SearchSettings, tune_table

files, params, output = snakemake.input, snakemake.params, snakemake.output
dataset, model, tuning, threads = *snakemake.wildcards, params.tuning, snakemake.threads
spec = MODELS[model]
searched = [preset for preset in params.presets if preset in SEARCHED]
parameters = dict(zip(searched, output.parameters, strict=True))
n_trials = {TUNED: tuning["n_trials"], OUTER: tuning["n_outer_trials"]}
of_searched = (output.parameters, output.trials, output.held_out)
of_presets = zip(params.presets, map(FitFiles, output.models, output.records, output.predictions), strict=True)


def settings_of(preset):
    """How the model is fitted by a preset."""
    if preset == PAPER:
        # The paper's models saw the coordinates that never move, and its R2 shows it.
        return FitSettings({**spec.paper_params, **params.overrides}, False, params.seed, threads)
    return searched_settings(read_json(parameters[preset]), params.robot["base"], params.seed, threads)


with job(snakemake.log[0], f"fit {dataset} {model}", snakemake.output, snakemake.input, snakemake.params):
    if searched:
        tune_table(
            files.table,
            spec=spec,
            robot=Robot(**params.robot),
            settings=TuningSettings(tuning["n_trials"], tuning["n_folds"], tuning["max_rows"], params.seed),
            search=SearchSettings(
                {preset: n_trials[preset] for preset in searched},
                {TUNED, *searched, *([] if params.objective == INTERPOLATION else [OUTER])},
                tuning["max_markers"],
                tuning["core_shares"],
                params.target_spaces,
            ),
            files=dict(zip(searched, map(PresetFiles, params.studies, *of_searched), strict=True)),
            code=params.study_code,
            threads=threads,
        )
    fits = [(settings_of(preset), of_preset) for preset, of_preset in of_presets]
    fit_each(files.table, spec=spec, fits=fits, max_rows=params.max_rows)
    write_manifest(output.manifest, [file for file in output if file != output.manifest])
