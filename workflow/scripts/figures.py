"""Rule figures: draw every figure of a dataset."""

from pathlib import Path

from softkin.figures import FIGURES
from softkin.figures.drawing import draw
from softkin.files import read_json
from softkin.interface import DatasetResults
from softkin.intervals import INTERVAL_METHODS
from softkin.job import job

given, methods, dataset = snakemake.input, snakemake.params.methods, snakemake.wildcards.dataset
with job(snakemake.log[0], f"figures {dataset}"):
    leak = " (LEAK: test rows stand in train)" if read_json(given.data_card)["is_leaking"] else ""
    results = DatasetResults(
        dataset=dataset,
        title=read_json(given.description)["title"] + leak,
        table=Path(given.table),
        intervals={method: Path(path) for method, path in zip(methods, given.intervals, strict=True)},
        choice=Path(given.choice),
        conditional=Path(given.conditional),
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        on_quantiles={name: method.on == "quantiles" for name, method in INTERVAL_METHODS.items()},
    )
    draw(FIGURES, results, Path(snakemake.output[0]))
