# One run at a time in a folder, see src/softkin/cli/one_run.py; what a killed run has left is cleared before anything is
# looked at, and results that are not as they were written are made anew. No rule of its own.
import gc
import os
import shlex
import sys
import time

from softkin.campaigns.crate import write_crate
from softkin.cli.one_run import OneRun, only_looks
from softkin.cli.partial_tables import PARTIAL
from softkin.cli.redo import redo_damaged
from softkin.core.files import write_json

# Snakemake (9.27.1) writes the interpreter into command lines as it is: with a blank in its path no script would start.
sys.executable = shlex.quote(sys.executable)

# How many jobs a run has to do, and how many there are: a campaign reads it.
JOBS = Path("results/logs/jobs.json")


def take_folder():
    """Be the only run here, or stop."""
    try:
        for sentence in RUN.take():
            print(f"softkin: {sentence}.", file=sys.stderr)
    except SoftkinError as error:
        raise WorkflowError(str(error)) from None


def counted_jobs():
    """How many jobs this run does, and how many there are."""
    needed = workflow.dag.needrun_jobs(exclude_finished=False)
    counts = [
        sum(not job.is_norun for job in jobs) for jobs in (needed, workflow.dag.jobs)
    ]
    return dict(zip(("run", "all"), counts, strict=True))


def start_of_jobs():
    """Write how many jobs this run does."""
    gc.enable()
    STARTED.append(time.time())
    if PARTIAL not in os.environ:  # those of the run that failed count
        write_json(JOBS, counted_jobs())


def describe_results():
    """Write what the run made, from what and when, as a Workflow Run RO-Crate beside the results: of a run that has all
    of them.
    """
    if PARTIAL in os.environ:
        return
    write_crate(
        "results",
        workflow=Path(workflow.basedir) / "Snakefile",
        title=f"softkin {config['campaign']}",
        started=STARTED[-1],
        ended=time.time(),
    )


STARTED = []
if workflow.is_main_process and not only_looks(sys.argv):
    RUN = OneRun.of(Path.cwd())
    take_folder()
if workflow.is_main_process:
    # Of the jobs of unknown params rules/other_params.smk asks, when all rules are there.
    DAMAGED, OF_UNKNOWN_PARAMS = redo_damaged(only_say=only_looks(sys.argv))
    for damaged in DAMAGED:
        print(f"softkin: {damaged}.", file=sys.stderr)
