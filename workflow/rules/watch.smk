# The view of a run on the terminal, see src/softkin/cli/watching. No rule of its own.
import time

from softkin.cli.watching.job import Job, in_order
from softkin.cli.watching.progress import Progress
from softkin.cli.watching.timings import Timings, measured_seconds
from softkin.cli.watching.view import SNAKEMAKES_OWN, View

# What each job took in a run of the default configuration: `make timings`.
TIMINGS = Path(workflow.basedir) / "resources" / "timings.csv"


def jobs_to_do():
    """Every job of this run, with its seconds in the run before: read at the start, since a job that starts deletes them."""
    numbers = {
        job: workflow.dag.jobid(job)
        for job in workflow.dag.needrun_jobs()
        if not job.is_norun
    }
    timings = Timings.read(TIMINGS)
    jobs = {
        number: Job(
            stage_of(job.rule.name),
            dict(job.wildcards_dict),
            timings.seconds(stage_of(job.rule.name), job.wildcards_dict),
            Path(job.log[0]) if job.log else None,
            measured_seconds(job.benchmark),
            [
                numbers[needed]
                for needed in workflow.dag.job_dependencies(job)
                if needed in numbers
            ],
            job.priority,
        )
        for job, number in numbers.items()
    }
    return in_order(jobs, [stage_of(rule.name) for rule in workflow.rules])


def jobs_at_a_time():
    """How many jobs may run at a time: as many as --cores says, or --jobs where an executor hands them out."""
    settings = workflow.resource_settings
    return min(filter(None, (settings.cores, settings.nodes)), default=1)


def watch():
    """Show the run by softkin's view; by Snakemake's own where --quiet, --verbose or a logger plugin was asked for."""
    settings, logger = workflow.output_settings, workflow.logger_manager.logger
    own = [handler for handler in logger.handlers if handler.name == SNAKEMAKES_OWN]
    asked_otherwise = settings.quiet or settings.verbose or settings.printshellcmds
    if not own or asked_otherwise:
        return
    progress = Progress(jobs_to_do(), jobs_at_a_time(), time.monotonic())
    VIEWS.append(View(progress, own[0], f"softkin {config['campaign']}"))
    VIEWS[0].start(logger)


def stop_watching():
    """End the view, before anything is printed at the end."""
    while VIEWS:
        VIEWS.pop().finish(workflow.logger_manager.logger)


VIEWS = []
