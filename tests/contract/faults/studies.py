"""Faults of studies."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

JOURNAL = "unit/training/test_journal.py"
STUDY = "unit/training/test_study.py"
BAD = "contract/test_bad_inputs.py::test_a_bad_input_has_one_message_with_place_and_fix"

FAULTS = [
    Fault(
        "a study is killed between any two writes",
        "it ends with the same trials",
        f"{JOURNAL}::test_a_study_killed_between_any_two_writes_ends_as_an_undisturbed_one",
    ),
    Fault(
        "a study is killed in a trial",
        "it ends with the same trials",
        f"{STUDY}::test_a_killed_study_ends_as_an_undisturbed_one",
    ),
    Fault(
        "the last record is torn at any byte",
        "cut off, and the study goes on",
        f"{JOURNAL}::test_a_last_record_torn_at_any_byte_heals",
    ),
    Fault(
        "the last line is garbage",
        "cut off, and the study goes on",
        f"{JOURNAL}::test_a_last_line_that_is_no_record_heals",
    ),
    Fault(
        "the file is no journal",
        "replaced, and the log says so",
        f"{JOURNAL}::test_a_file_that_is_no_journal_is_replaced_and_the_log_says_so",
    ),
    Fault(
        "the file is the journal of another study",
        "replaced, and the log says so",
        f"{JOURNAL}::test_the_journal_of_another_study_is_replaced_and_the_log_says_so",
    ),
    Fault(
        "a killed process has left its lock",
        "nobody is held up",
        f"{JOURNAL}::test_a_lock_that_a_killed_process_left_holds_nobody_up",
    ),
    Fault("the seed changed", "a new study", f"{STUDY}::test_another_seed_starts_a_new_study"),
    Fault("Optuna refuses a study", "one message with its fix", BAD),
]
