"""Rule fit_orientation: a model of the orientation of a robot's tip, and its scores."""

import joblib

from softkin.core.files import read_json, replacing
from softkin.core.job import job
from softkin.evaluation.score_orientation import score_orientation
from softkin.uncertainty.build_orientation_model import orientation_model

files, params, output, dataset = snakemake.input, snakemake.params, snakemake.output, snakemake.wildcards.dataset
with job(snakemake.log[0], f"fit orientation {dataset}", snakemake.output, snakemake.input, snakemake.params):
    model = orientation_model(files.table, read_json(files.description), seed=params.seed, threads=snakemake.threads)
    with replacing(output.model) as temporary:
        joblib.dump(model, temporary, compress=3)
    score_orientation(
        model, files.table, dataset=dataset, confidence_levels=params.confidence_levels, output=output.scores
    )
