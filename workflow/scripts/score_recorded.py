"""Rule score_recorded: the deployed run of a recorded dataset, scored in time."""

from softkin.core.files import read_json
from softkin.core.job import job
from softkin.core.manifest import files_of_runs
from softkin.core.runs import Run, nearest_level
from softkin.evaluation.score_recorded import Member, RecordedRun, score_recorded
from softkin.models import MODELS
from softkin.training.kinematic_model import recorded_settings
from softkin.training.members import members_of
from softkin.uncertainty.choose import deployed_choice

files, params, dataset, threads = snakemake.input, snakemake.params, snakemake.wildcards.dataset, snakemake.threads
with job(snakemake.log[0], f"score recorded {dataset}", snakemake.output, snakemake.input, snakemake.params):
    best = deployed_choice(files.choice)
    run = None
    if best is not None:
        deployed = Run(best["model"], best["preset"])
        records = files_of_runs(files.models, params.runs, "fit.json")
        members = [
            Member(
                MODELS[member.model],
                recorded_settings(read_json(records[member]), params.seed, threads),
                weight,
                params.max_fit_rows.get(member.model),
            )
            for member, weight in members_of(deployed, records[deployed]).items()
        ]
        run = RecordedRun(deployed, members, params.seed, nearest_level(params.confidence_levels))
    score_recorded(files.table, dataset=dataset, run=run, output=snakemake.output[0])
