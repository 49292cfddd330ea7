# The view of a run on the terminal, see src/softkin/cli/watching. No rule of its own.
import time

from softkin.cli.watching.progress import Job, Progress, in_order, measured_seconds
from softkin.cli.watching.view import SNAKEMAKES_OWN, View


def jobs_to_do():
    """Every job of this run, with its seconds in the run before: read at the start, since a job that starts deletes them."""
    numbers = {workflow.dag.jobid(job): job for job in workflow.dag.needrun_jobs()}
    jobs = {
        number: Job(
            job.rule.name,
            dict(job.wildcards_dict),
            Path(job.log[0]) if job.log else None,
            measured_seconds(job.benchmark),
        )
        for number, job in numbers.items()
        if not job.is_norun
    }
    return in_order(jobs, [rule.name for rule in workflow.rules])


def watch():
    """Show the run by softkin's view; by Snakemake's own where --quiet, --verbose or a logger plugin was asked for."""
    settings, logger = workflow.output_settings, workflow.logger_manager.logger
    own = [handler for handler in logger.handlers if handler.name == SNAKEMAKES_OWN]
    asked_otherwise = settings.quiet or settings.verbose or settings.printshellcmds
    if not own or asked_otherwise:
        return
    progress = Progress(jobs_to_do(), workflow.cores or 1, time.monotonic())
    VIEWS.append(View(progress, own[0], f"softkin {config['campaign']}"))
    VIEWS[0].start(logger)


def stop_watching():
    """End the view, before anything is printed at the end."""
    while VIEWS:
        VIEWS.pop().finish(workflow.logger_manager.logger)


VIEWS = []
