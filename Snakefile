# softkin: from published data to a calibrated forward kinematics. `snakemake --cores 2` is all it takes.
#     retrieve -> prepare -> fit (tune, fit, predict) -> refit -> calibrate -> score -> tables -> report
#                    \-> audit                                                   \-> figures -> track (MLflow)
from pathlib import Path

from snakemake.utils import min_version

min_version("9.0")


report: "workflow/report/workflow.rst"


include: "workflow/rules/configuration.smk"
include: "workflow/rules/one_run.smk"
include: "workflow/rules/paths.smk"
include: "workflow/rules/deciding_code.smk"
include: "workflow/rules/retrieve.smk"
include: "workflow/rules/prepare.smk"
include: "workflow/rules/audit.smk"
include: "workflow/rules/fit.smk"
include: "workflow/rules/refit.smk"
include: "workflow/rules/calibrate.smk"
include: "workflow/rules/score.smk"
include: "workflow/rules/score_recorded.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/summarise.smk"
include: "workflow/rules/timed_jobs.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/track.smk"
include: "workflow/rules/local.smk"
include: "workflow/rules/watch.smk"
include: "workflow/rules/final_screen.smk"
include: "workflow/rules/partial_tables.smk"
include: "workflow/rules/other_params.smk"


rule all:
    default_target: True
    input:
        final_output(),


onstart:
    start_of_jobs()
    warn_of_stand_ins()
    watch()


onsuccess:
    stop_watching()
    describe_results()
    print_final_screen()


onerror:
    stop_watching()
    warn_of_stand_ins()
    plan_partial_tables()
