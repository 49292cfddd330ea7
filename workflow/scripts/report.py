"""Rule report: one page that tells the run."""

from pathlib import Path

from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.models import MODELS
from softkin.outside import OUTSIDE_METHODS
from softkin.regions import REGION_METHODS
from softkin.report.building import build_report
from softkin.report.jobs import Job

given, params = snakemake.input, snakemake.params
datasets = params.config["datasets"]
methods = {**INTERVAL_METHODS, **REGION_METHODS, **OUTSIDE_METHODS}
with job(snakemake.log[0], "report"):
    build_report(
        tables=given.tables,
        descriptions=dict(zip(datasets, given.descriptions, strict=True)),
        data_cards=dict(zip(datasets, given.data_cards, strict=True)),
        card_pages=dict(zip(datasets, given.card_pages, strict=True)),
        figures=dict(zip(datasets, given.figures, strict=True)),
        campaign_figures=given.campaign_figures,
        jobs=[Job(*run, Path(benchmark), tuple(map(Path, records))) for run, benchmark, records in params.jobs],
        config=params.config,
        model_titles={name: spec.title for name, spec in MODELS.items()},
        interval_titles={name: method.title for name, method in methods.items()},
        citation=given.citation,
        report=snakemake.output[0],
    )
