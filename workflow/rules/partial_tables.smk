# When a job has failed: tables and report of what is there, see src/softkin/cli/partial_tables.py. A second Snakemake makes
# them when this one has ended; and where a job of that one fails, a third, of still less. No rule of its own.
import atexit

from softkin.cli.partial_tables import OF_ONE, Undone, plan, run_partial
from softkin.core.failed_parts import failed_parts


def undone_jobs():
    """The jobs that this run should have done and has not."""
    failed = workflow.scheduler.failed
    for job in workflow.dag.needrun_jobs():
        if not job.is_norun:
            name, wildcards = stage_of(job.rule.name), dict(job.wildcards_dict)
            dataset = wildcards.pop("dataset", "")
            parts = [(OF_ONE[name], of) for of in wildcards.values() if name in OF_ONE]
            if job in failed and job.log:
                parts += failed_parts(job.log[0])
            words = " ".join([name, *wildcards.values()])
            yield Undone(name, dataset, words, job in failed, parts)


def plan_partial_tables():
    """Have tables and report of what is there made at the end, where this run would have made those of everything."""
    asked_for = {str(file) for job in workflow.dag.jobs for file in job.output}
    if workflow.scheduler._user_kill or REPORT not in asked_for:
        return
    on_quantiles = [
        name
        for name, method in INTERVAL_METHODS.items()
        if method.calibrated_on.needs_quantiles
    ]
    partial = plan(
        config,
        list(undone_jobs()),
        left_out=LEFT_OUT,
        on_quantiles=on_quantiles,
        complete=COMPLETE if IS_PARTIAL else None,
    )
    if partial:
        atexit.register(make_partial_tables, partial, Path.cwd())


def make_partial_tables(partial, folder):
    """Hand the folder over to the run that makes them. The exit code stays that of this one."""
    os.chdir(folder)
    RUN.lock.release()
    print(
        f"softkin: {partial.missing} Tables and report of the rest follow.",
        file=sys.stderr,
        flush=True,
    )
    command = [shlex.split(sys.executable)[0], "-m", "snakemake"]
    command += ["--snakefile", str(workflow.main_snakefile)]
    if workflow.overwrite_workdir:  # else paths are shown as they are from here
        command += ["--directory", str(folder)]
    cores = workflow.resource_settings.cores or 1
    run_partial(partial, config, command=command, cores=cores, report=REPORT)
