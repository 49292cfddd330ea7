"""Rule build_report: one page on the run."""

from pathlib import Path

from softkin.core.job import job
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.reporting.page.build import RobotFiles, build_report
from softkin.reporting.page.jobs import Job
from softkin.reporting.titles import Titles
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.regions.spec import JOINT_INTERVALS, JOINT_TITLE

files, params = snakemake.input, snakemake.params
datasets = params.config["datasets"]
methods = {**INTERVAL_METHODS, **REGION_METHODS, **LABELLED_METHODS}
method_titles = {name: method.title for name, method in methods.items()} | {JOINT_INTERVALS: JOINT_TITLE}
of_robots = zip(files.descriptions, files.data_cards, files.card_pages, files.figures, strict=True)
with job(snakemake.log[0], "build report", snakemake.output, snakemake.input, snakemake.params):
    build_report(
        tables=files.tables,
        robots={name: RobotFiles(*of_robot) for name, of_robot in zip(datasets, of_robots, strict=True)},
        campaign_figures=files.campaign_figures,
        jobs=[
            Job(
                *run,
                benchmark=Path("results", "benchmarks", f"{place}.tsv"),
                log=Path("results", "logs", f"{place}.log"),
                records=tuple(map(Path, records)),
            )
            for run, place, records in params.jobs
        ],
        config=params.config,
        titles=Titles(
            {name: spec.title for name, spec in (MODELS | ENSEMBLES).items()},
            method_titles,
        ),
        citation=Path(snakemake.scriptdir).resolve().parents[1] / "CITATION.cff",
        report=snakemake.output[0],
    )
