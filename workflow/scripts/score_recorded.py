"""Rule score_recorded: the deployed run of a recorded dataset, scored in time."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.manifest import files_of_runs
from softkin.core.runs import Run, nearest_level
from softkin.evaluation.score_recorded import RecordedRun, score_recorded
from softkin.models import MODELS
from softkin.training.kinematic_model import recorded_settings
from softkin.uncertainty.choose import deployed_choice

files, params, dataset = snakemake.input, snakemake.params, snakemake.wildcards.dataset
with job(snakemake.log[0], f"score recorded {dataset}", snakemake.output, params=snakemake.params):
    best = deployed_choice(files.choice)
    run = None
    if best is not None:
        deployed = Run(best["model"], best["preset"])
        record = read_json(files_of_runs(files.models, params.runs, "fit.json")[deployed])
        settings = recorded_settings(record, params.seed, snakemake.threads)
        run = RecordedRun(MODELS[deployed.model], deployed.preset, settings, nearest_level(params.confidence_levels))
    score_recorded(files.table, dataset=dataset, run=run, output=snakemake.output[0])
