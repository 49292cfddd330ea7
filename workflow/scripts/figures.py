"""Rule figures: draw every figure of a dataset."""

from pathlib import Path

from softkin.figures import FIGURES
from softkin.figures.drawing import draw
from softkin.files import read_json
from softkin.findings import LEAK
from softkin.interface import DatasetResults
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.models import MODELS
from softkin.quantile_models import QUANTILE_MODELS

given, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
learners = QUANTILE_MODELS | MODELS


def by(names, paths):
    """Paths by name."""
    return dict(zip(names, map(Path, paths), strict=True))


with job(snakemake.log[0], f"figures {dataset}"):
    notes = dict(params.source.get("notes", {}))
    for finding in read_json(given.data_card)["findings"]:
        for subset in finding["subsets"] if finding["severity"] == LEAK else ():
            notes[subset] = f"LEAK: {finding['sentence']} {notes.get(subset, '')}".strip()
    results = DatasetResults(
        dataset=dataset,
        title=read_json(given.description)["title"],
        table=Path(given.table),
        predictions=by(map(tuple, params.runs), given.predictions),
        trials=by(params.tuned, given.trials),
        intervals=by(params.methods, given.intervals),
        point=Path(given.point),
        interval_metrics=Path(given.interval_metrics),
        choice=Path(given.choice),
        conditional=Path(given.conditional),
        outside=Path(given.outside),
        spaces=Path(given.spaces),
        notes=notes,
        model_titles={name: spec.title for name, spec in learners.items()},
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        on_quantiles={name: method.on == "quantiles" for name, method in INTERVAL_METHODS.items()},
    )
    draw(FIGURES, results, Path(snakemake.output[0]))
