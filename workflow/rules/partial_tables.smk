# When a job has failed: tables and report of the datasets that are complete, see src/softkin/cli/partial_tables.py. A
# second Snakemake makes them when this one has ended. No rule of its own.
import atexit

from softkin.cli.partial_tables import (
    Undone,
    complete_datasets,
    run_without,
    what_is_missing,
)


def undone_jobs():
    """The jobs that this run should have done and has not."""
    failed = workflow.scheduler.failed
    for job in workflow.dag.needrun_jobs():
        if not job.is_norun:
            wildcards = dict(job.wildcards_dict)
            dataset = wildcards.pop("dataset", "")
            words = " ".join([job.rule.name, *wildcards.values()])
            yield Undone(job.rule.name, dataset, words, job in failed)


def plan_partial_tables():
    """Have tables and report of the complete datasets made at the end, where this run would have made those of all."""
    asked_for = {str(file) for job in workflow.dag.jobs for file in job.output}
    stopped = workflow.scheduler._user_kill
    if PARTIAL in os.environ or stopped or REPORT not in asked_for:
        return
    undone = list(undone_jobs())
    complete = complete_datasets(config["datasets"], undone)
    if complete:
        missing = what_is_missing(config["datasets"], complete, undone)
        atexit.register(make_partial_tables, missing, complete, Path.cwd())


def make_partial_tables(missing, complete, folder):
    """Hand the folder over to the run that makes them. The exit code stays that of this one."""
    os.chdir(folder)
    RUN.lock.release()
    print(
        f"softkin: {missing} Tables and report of the others follow.",
        file=sys.stderr,
        flush=True,
    )
    command = [shlex.split(sys.executable)[0], "-m", "snakemake"]
    command += ["--snakefile", str(workflow.main_snakefile)]
    if workflow.overwrite_workdir:  # else paths are shown as they are from here
        command += ["--directory", str(folder)]
    run_without(missing, complete, config, command=command, report=REPORT)
