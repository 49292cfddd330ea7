"""Rule fit_ensemble: weight the searched runs of a dataset by each searched preset, and predict with their mean."""

from softkin.core.job import job
from softkin.core.manifest import files_of_runs, write_manifest
from softkin.core.runs import INTERPOLATION, OUTER, TUNED
from softkin.models.ensembles import ENSEMBLES
from softkin.training.ensemble import EnsembleFiles, MemberFiles, fit_ensemble
from softkin.training.held_out import PartSettings, Robot

files, params, output, tuning = snakemake.input, snakemake.params, snakemake.output, snakemake.params.tuning
dataset, name = snakemake.wildcards
kinds = ("model.joblib", "fit.json", "held_out.npz", "predictions.parquet")
of_runs = [files_of_runs(files.models, params.runs, kind) for kind in kinds]
of_presets = map(EnsembleFiles, output.models, output.records, output.predictions, output.parameters, output.trials)

with job(snakemake.log[0], f"fit {dataset} {name}", snakemake.output, snakemake.input, snakemake.params):
    fit_ensemble(
        files.table,
        spec=ENSEMBLES[name],
        robot=Robot(**params.robot),
        settings=PartSettings(
            tuning["n_folds"],
            tuning["core_shares"],
            tuning["max_rows"],
            tuning["max_markers"],
            {TUNED, *params.presets, *([] if params.objective == INTERPOLATION else [OUTER])},
            params.seed,
        ),
        members={run: MemberFiles(*(of_kind[run] for of_kind in of_runs)) for run in of_runs[0]},
        files=dict(zip(params.presets, of_presets, strict=True)),
        threads=snakemake.threads,
    )
    write_manifest(output.manifest, [file for file in output if file != output.manifest])
