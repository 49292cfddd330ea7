"""Rule draw_figures: draw every figure of a dataset."""

from pathlib import Path

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.manifest import files_of, files_of_runs
from softkin.core.units import unit_of
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.quantile import QUANTILE_MODELS
from softkin.reporting.figures import FIGURES
from softkin.reporting.figures.drawing import draw
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.notes import subset_notes
from softkin.uncertainty.intervals import INTERVAL_METHODS

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
specs = QUANTILE_MODELS | MODELS | ENSEMBLES


with job(snakemake.log[0], f"draw figures {dataset}", snakemake.output, snakemake.input, snakemake.params):
    about = read_json(files.description)
    trials = files_of_runs(files.models, params.tuned, "trials.csv")
    results = DatasetResults(
        dataset=dataset,
        title=about["title"],
        table=Path(files.table),
        predictions=files_of_runs(files.models, params.runs, "predictions.parquet"),
        trials={run.model: path for run, path in trials.items()},
        intervals=files_of(files.intervals, {name: f"{name}.parquet" for name in params.methods}),
        point=Path(files.point),
        interval_metrics=Path(files.interval_metrics),
        choice=Path(files.choice),
        conditional=Path(files.conditional),
        extrapolation=Path(files.extrapolation),
        target_spaces=Path(files.target_spaces),
        notes=subset_notes(read_json(files.data_card), params.source.get("notes", {})),
        model_titles={name: spec.title for name, spec in specs.items()},
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        has_own_regressors={
            name: not method.calibrated_on.is_around_a_model for name, method in INTERVAL_METHODS.items()
        },
        unit=unit_of(about),
    )
    draw(FIGURES, results, Path(snakemake.output[0]))
