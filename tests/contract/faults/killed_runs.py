"""Faults of runs that are killed."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

ONE_RUN = "unit/cli/test_one_run.py"
CAMPAIGN = "unit/cli/test_campaign.py"
PROCESS = "unit/cli/test_workflow_process.py"
KILLS = "workflow/test_kills.py::test_a_run_that_was_killed_ends_as_an_undisturbed_one"
ENDS_EQUAL = "the next plain run finishes, with the tables of an undisturbed one"

FAULTS = [
    Fault("`kill -9` of Snakemake at a random moment", ENDS_EQUAL, KILLS),
    Fault("`kill -9` of a job", ENDS_EQUAL, KILLS),
    Fault("`kill -9` of Snakemake and its jobs at once", ENDS_EQUAL, KILLS),
    Fault("SIGHUP to Snakemake and its jobs at a random moment", ENDS_EQUAL, KILLS),
    Fault(
        "the terminal is closed in the middle of a fit",
        "the run and its job end; the next one clears the lock and finishes, with the same predictions",
        "workflow/test_watching.py::test_where_the_terminal_is_closed_the_next_run_finishes_and_has_an_estimate",
    ),
    Fault("killed while data are retrieved", ENDS_EQUAL, KILLS),
    Fault("killed while runs are logged", f"{ENDS_EQUAL}, each run once", KILLS),
    Fault(
        "a campaign is killed half-way",
        "the next one ends with 0",
        "workflow/test_campaign.py::test_five_nights_in_a_row",
    ),
    Fault(
        "SIGTERM, SIGINT or SIGHUP to a campaign",
        "it ends with all its jobs, also deaf ones",
        f"{PROCESS}::test_a_signal_ends_the_workflow_with_its_jobs",
    ),
    Fault(
        "a campaign was stopped",
        "the verdict says by which signal",
        f"{CAMPAIGN}::test_a_campaign_that_was_stopped_says_by_what",
    ),
    Fault(
        "a campaign is stopped while its results are judged",
        "the verdict says by which signal",
        f"{CAMPAIGN}::test_a_campaign_that_is_stopped_while_it_is_judged_says_so",
    ),
    Fault(
        "a campaign is killed, and has no verdict",
        "`unfinished` stands in the place of the verdict before",
        f"{CAMPAIGN}::test_a_campaign_that_was_killed_leaves_no_verdict_of_the_one_before",
    ),
    Fault(
        "a campaign is killed while it is logged",
        "the next one removes the half run",
        "unit/tracking/test_nights.py::test_what_a_killed_campaign_left_half_logged_is_removed",
    ),
    Fault(
        "the lock, the jobs and the half files of a killed run are left",
        "cleared, and said",
        f"{ONE_RUN}::test_what_a_killed_run_left_is_cleared_and_named",
    ),
    Fault(
        "an orphan that ignores SIGTERM",
        "ended by force",
        f"{ONE_RUN}::test_a_process_that_does_not_listen_is_ended_by_force",
    ),
    Fault(
        "a note of who runs is torn",
        "nobody is held up",
        f"{ONE_RUN}::test_what_a_killed_run_noted_of_itself_holds_nobody_up",
    ),
    Fault(
        "the count of jobs is torn",
        "unknown, and the campaign goes on",
        f"{PROCESS}::test_a_count_that_was_torn_by_a_kill_is_unknown",
    ),
    Fault(
        "everything is redone, and that fails",
        "the studies from before come back",
        f"{PROCESS}::test_studies_start_anew_and_come_back_where_the_workflow_fails",
    ),
    Fault(
        "everything is redone, and that is killed",
        "the studies from before come back at the next campaign, but for those begun anew",
        f"{PROCESS}::test_studies_that_a_killed_refit_put_aside_come_back",
    ),
]
