"""Rule tables: the tables across datasets."""

from pathlib import Path

from softkin.intervals import INTERVAL_METHODS
from softkin.job import job
from softkin.models import MODELS
from softkin.tables.build import build_tables

with job(snakemake.log[0], "tables"):
    build_tables(
        point=snakemake.input.point,
        markers=snakemake.input.markers,
        intervals=snakemake.input.intervals,
        choices=dict(zip(snakemake.params.sources, snakemake.input.choices, strict=True)),
        conditional=snakemake.input.conditional,
        alarms=snakemake.input.alarms,
        outside=snakemake.input.outside,
        spaces=snakemake.input.spaces,
        descriptions=snakemake.input.descriptions,
        data_cards=snakemake.input.data_cards,
        parameters=snakemake.input.parameters,
        studies=[tuple(study) for study in snakemake.params.studies],
        objective=snakemake.params.objective,
        sources=snakemake.params.sources,
        model_titles={name: spec.title for name, spec in MODELS.items()},
        published=snakemake.input.published,
        published_subsets=snakemake.input.subsets,
        published_intervals=snakemake.input.published_intervals,
        interval_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        folder=Path(snakemake.output.headline).parent,
    )
