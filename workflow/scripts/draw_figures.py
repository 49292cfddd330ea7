"""Rule draw_figures: draw every figure of a dataset."""

from pathlib import Path

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.runs import Run
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.reporting.figures import FIGURES
from softkin.reporting.figures.drawing import draw
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.notes import subset_notes
from softkin.uncertainty.intervals import INTERVAL_METHODS

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
specs = QUANTILE_MODELS | MODELS


def by_name(names, paths):
    """The paths by name, in the same order."""
    return dict(zip(names, map(Path, paths), strict=True))


with job(snakemake.log[0], f"draw figures {dataset}"):
    results = DatasetResults(
        dataset=dataset,
        title=read_json(files.description)["title"],
        table=Path(files.table),
        predictions=by_name([Run(*run) for run in params.runs], files.predictions),
        trials=by_name(params.tuned, files.trials),
        intervals=by_name(params.methods, files.intervals),
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
    )
    draw(FIGURES, results, Path(snakemake.output[0]))
