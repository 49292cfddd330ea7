"""Faults of the machine that softkin runs on."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

RECORDS = "unit/core/test_job_records.py"
ONE_RUN = "unit/cli/test_one_run.py"
CAMPAIGN = "unit/cli/test_campaign.py"
BAD = "contract/test_bad_inputs.py::test_a_bad_input_has_one_message_with_place_and_fix"

FAULTS = [
    Fault("the disk is full", "one message that names the file; what is finished is kept", BAD),
    Fault("a folder may not be written", "one message that names it", BAD),
    Fault(
        "a folder is in the place of the verdict, or the results cannot be written, when a campaign begins",
        "one message that names it, exit code 1",
        f"{CAMPAIGN}::test_what_cannot_be_written_is_one_message",
    ),
    Fault("the memory is used up", "one message with its fix", BAD),
    Fault(
        "the clock jumps ahead or back",
        "results stay what their content is",
        f"{RECORDS}::test_clocks_that_jump_and_files_dated_in_the_future_are_no_damage",
    ),
    Fault(
        "files are dated in the future",
        "results stay what their content is",
        f"{RECORDS}::test_clocks_that_jump_and_files_dated_in_the_future_are_no_damage",
    ),
    Fault(
        "the clock was set back during a campaign",
        "the verdict still says why",
        f"{CAMPAIGN}::test_a_clock_that_was_set_back_takes_no_reason_away",
    ),
    Fault(
        "two runs in one folder",
        "the second is told who runs since when",
        f"{ONE_RUN}::test_a_second_run_is_told_who_runs_since_when",
    ),
    Fault(
        "two campaigns in one folder",
        "the second ends with 75",
        f"{CAMPAIGN}::test_a_second_campaign_is_told_who_runs_one_since_when",
    ),
    Fault(
        "the lock is held and its note torn",
        "the second ends with 75",
        f"{CAMPAIGN}::test_a_torn_note_of_who_holds_the_lock_is_no_traceback",
    ),
    Fault(
        "the pipe of the output is closed",
        "the run goes on",
        "unit/cli/watching/test_view.py::test_a_closed_pipe_does_not_stop_the_run",
    ),
    Fault("the port of the UI is taken", "one sentence", "unit/cli/test_ui.py::test_a_busy_port_is_one_sentence"),
]
