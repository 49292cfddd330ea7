# What is printed at the end of a run that did not fail, see src/softkin/cli/final_screen.py. No rule of its own.
from snakemake.common import NOTHING_TO_BE_DONE_MSG

from softkin.cli.final_screen import AtMessage, final_screen


def print_final_screen():
    """Print what this run has made, or found up to date."""
    made = {str(file) for job in workflow.dag.jobs for file in job.output}
    counts = counted_jobs()
    place = Path(workflow.overwrite_workdir or "")
    text = final_screen(
        place, made, config["datasets"], jobs=(counts["run"], counts["all"])
    )
    print(text, flush=True)
    warn_of_stand_ins()


# A run with nothing to do has no hook.
if workflow.is_main_process and not only_looks(sys.argv):
    workflow.logger_manager.logger.addHandler(
        AtMessage(NOTHING_TO_BE_DONE_MSG, print_final_screen)
    )
