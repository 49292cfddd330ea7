"""Rule draw_figures: draw every figure of a dataset."""

from pathlib import Path

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS
from softkin.data.audit.findings import leak_notes
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.reporting.figures import FIGURES
from softkin.reporting.figures.drawing import draw
from softkin.reporting.figures.spec import DatasetResults
from softkin.uncertainty.intervals import INTERVAL_METHODS

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
specs = QUANTILE_MODELS | MODELS


def by(names, paths):
    """Paths by name."""
    return dict(zip(names, map(Path, paths), strict=True))


with job(snakemake.log[0], f"draw figures {dataset}"):
    leaks = leak_notes(read_json(files.data_card))
    notes = {s: f"{leaks.get(s, '')} {params.source.get('notes', {}).get(s, '')}".strip() for s in SUBSETS}
    results = DatasetResults(
        dataset=dataset,
        title=read_json(files.description)["title"],
        table=Path(files.table),
        predictions=by([Run(*run) for run in params.runs], files.predictions),
        trials=by(params.tuned, files.trials),
        intervals=by(params.methods, files.intervals),
        point=Path(files.point),
        interval_metrics=Path(files.interval_metrics),
        choice=Path(files.choice),
        conditional=Path(files.conditional),
        outside=Path(files.outside),
        spaces=Path(files.spaces),
        notes={subset: note for subset, note in notes.items() if note},
        model_titles={name: spec.title for name, spec in specs.items()},
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        has_own_regressors={name: not of.calibrated_on.is_around_a_model for name, of in INTERVAL_METHODS.items()},
    )
    draw(FIGURES, results, Path(snakemake.output[0]))
