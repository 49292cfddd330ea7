"""Rule fit_quantiles: search a quantile regressor; fit and predict by each preset."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.manifest import write_manifest
from softkin.core.runs import PAPER, TUNED, nearest_level
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.fit_quantiles import QuantileFiles, QuantileModel, fit_quantiles
from softkin.training.study import StudyFile, TuningSettings
from softkin.training.tune_quantiles import tune_quantiles

table, params, output = snakemake.input.table, snakemake.params, snakemake.output
dataset, model, tuning, threads = *snakemake.wildcards, params.tuning, snakemake.threads
spec = QUANTILE_MODELS[model]
of_presets = zip(params.presets, map(QuantileFiles, output.models, output.quantiles, output.records), strict=True)
with job(snakemake.log[0], f"fit quantiles {dataset} {model}", snakemake.output, snakemake.input, snakemake.params):
    fitted_with = dict.fromkeys(params.presets, spec.paper_params)
    if TUNED in params.presets:
        tune_quantiles(
            table,
            spec=spec,
            settings=TuningSettings(tuning["n_quantile_trials"], tuning["n_folds"], tuning["max_rows"], params.seed),
            file=StudyFile(params.study, params.study_code),
            threads=threads,
            parameters=output.parameters[0],
            trials=output.trials[0],
        )
        fitted_with[TUNED] = read_json(output.parameters[0])["params"]
    for preset, files in of_presets:
        # The paper has one level; its pair of quantiles serves all levels of CQR.
        levels = [nearest_level(params.confidence_levels)] if preset == PAPER else params.confidence_levels
        regressor = QuantileModel(spec, fitted_with[preset], levels, params.seed, threads)
        fit_quantiles(table, regressor=regressor, files=files, max_rows=params.max_rows)
    write_manifest(output.manifest, [file for file in output if file != output.manifest])
