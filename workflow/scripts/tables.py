"""Rule tables: the tables across datasets."""

from pathlib import Path

from softkin.job import job
from softkin.models import MODELS
from softkin.tables.build import build_tables

with job(snakemake.log[0], "tables"):
    build_tables(
        point=snakemake.input.point,
        markers=snakemake.input.markers,
        descriptions=snakemake.input.descriptions,
        parameters=snakemake.input.parameters,
        studies=[tuple(study) for study in snakemake.params.studies],
        sources=snakemake.params.sources,
        model_titles={name: spec.title for name, spec in MODELS.items()},
        published=snakemake.input.published,
        published_subsets=snakemake.input.subsets,
        folder=Path(snakemake.output.headline).parent,
    )
