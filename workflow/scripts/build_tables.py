"""Rule build_tables: the tables across datasets."""

from pathlib import Path

from softkin.core.job import job
from softkin.core.manifest import files_of_runs
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.reporting.tables.build import build_tables
from softkin.reporting.tables.frames import DatasetFiles, PublishedFiles, read_tables
from softkin.reporting.titles import Titles
from softkin.uncertainty.intervals import INTERVAL_METHODS

files, params = snakemake.input, snakemake.params
published = Path(snakemake.scriptdir).resolve().parents[1] / "resources" / "published"
kinds = ("point", "markers", "intervals", "choice", "conditional", "alarms", "extrapolation", "spaces", "left_out")
by_dataset = zip(*(files[kind] for kind in (*kinds, "description", "data_card")), strict=True)
manifests = {dataset: [] for dataset in params.sources}
for file in files.models:
    manifests[Path(file).parts[-3]].append(file)
parameters = {
    (dataset, *run): path
    for dataset, runs in params.searched.items()
    for run, path in files_of_runs(manifests[dataset], runs, "parameters.json").items()
}
with job(snakemake.log[0], "build tables", snakemake.output, snakemake.input, snakemake.params):
    tables = read_tables(
        {name: DatasetFiles(*of_dataset) for name, of_dataset in zip(params.sources, by_dataset, strict=True)},
        sources=params.sources,
        parameters=parameters,
        objective=params.objective,
        recorded=files.recorded,
        learning=files.learning,
        orientation=files.orientation,
        published=PublishedFiles(
            *(
                published / f"{name}.csv"
                for name in ("point_metrics", "subsets", "interval_metrics", "approaches", "improvements")
            )
        ),
    )
    build_tables(
        tables,
        titles=Titles(
            {name: spec.title for name, spec in (MODELS | ENSEMBLES).items()},
            {name: method.title for name, method in INTERVAL_METHODS.items()},
        ),
        folder=Path(snakemake.output.headline).parent,
        caution=params.caution,
    )
