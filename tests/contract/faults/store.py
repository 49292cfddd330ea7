"""Faults of the MLflow store."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

CAMPAIGN = "unit/cli/test_campaign.py"
STORE = "unit/tracking/test_store.py"
OPEN = "unit/tracking/test_open_store.py"
LOCK = "unit/tracking/test_lock.py"
ARTIFACTS = "unit/tracking/test_artifacts.py"
MODELS = "unit/tracking/test_models.py"
NO_STORE = f"{OPEN}::test_what_is_no_usable_store_is_named_with_its_fix_and_left_as_it_is"

FAULTS = [
    Fault(
        "it is lost",
        "one message; `make store` makes it again",
        f"{STORE}::test_a_lost_store_is_an_error_with_a_fix",
    ),
    Fault(
        "four processes make it at once",
        "it is made once",
        f"{STORE}::test_four_processes_may_create_the_store_at_once",
    ),
    Fault(
        "making it is killed half-way",
        "the next run makes it",
        f"{STORE}::test_a_store_whose_making_was_killed_is_made_anew",
    ),
    Fault("an experiment was deleted", "restored", f"{STORE}::test_a_deleted_experiment_comes_back"),
    Fault("it is locked for a minute", "waited for, up to two minutes", f"{OPEN}::test_a_locked_store_is_waited_for"),
    Fault(
        "it stays locked",
        "one message that names the file",
        f"{OPEN}::test_a_store_that_stays_locked_is_one_sentence",
    ),
    Fault(
        "it may not be written",
        "one message that names the file",
        f"{OPEN}::test_a_store_that_may_not_be_written_says_so",
    ),
    Fault(
        "it lies on a file system that is read-only",
        "one message that names the file",
        f"{OPEN}::test_sqlites_own_word_for_it_is_the_same",
    ),
    Fault("a text file or a picture is in its place", "one message; the file is left as it is", NO_STORE),
    Fault("a folder is in its place", "one message; the folder is left as it is", NO_STORE),
    Fault("the database of another program is in its place", "one message; it is left as it is", NO_STORE),
    Fault("an older MLflow made it", "one message with the command that brings it up to date", NO_STORE),
    Fault("a newer MLflow made it", "one message; it is left as it is", NO_STORE),
    Fault("it is cut in half or overwritten", "one message; it is left as it is", NO_STORE),
    Fault(
        "its file is empty",
        "it becomes a store",
        f"{OPEN}::test_an_empty_file_is_none_yet_and_mlflow_makes_one_of_it",
    ),
    Fault(
        "a server is dead",
        "one sentence after 10 s",
        "unit/tracking/test_server.py::test_a_dead_server_is_one_sentence_within_seconds",
    ),
    Fault(
        "a server says nothing",
        "one sentence after 10 s",
        "unit/tracking/test_server.py::test_a_server_that_says_nothing",
    ),
    Fault(
        "a proxy answers for a server that is gone",
        "one sentence",
        "unit/tracking/test_server.py::test_a_proxy_does_not_answer_for_its_server",
    ),
    Fault(
        "a store fails when a campaign is judged",
        "the verdict says so",
        f"{CAMPAIGN}::test_a_store_that_cannot_be_used_is_a_verdict",
    ),
    Fault(
        "MLflow fails when a campaign is judged",
        "the verdict says so",
        f"{CAMPAIGN}::test_an_error_of_mlflow_is_a_verdict_and_a_defect_is_not",
    ),
    Fault(
        "a run was cut off while it was logged",
        "removed and made again",
        f"{MODELS}::test_a_run_cut_off_before_its_end_is_removed_and_made_again",
    ),
    Fault(
        "a calibrated model was cut off before it was registered",
        "removed and made again",
        "unit/tracking/test_champion.py::test_a_model_that_was_cut_off_is_removed_and_made_again",
    ),
    Fault(
        "a logged model was cut off",
        "removed with its run",
        "unit/tracking/test_records.py::test_a_run_that_was_cut_off_is_swept_with_its_logged_model",
    ),
    Fault("artifacts are lost", "logged anew", f"{MODELS}::test_artifacts_that_are_gone_are_logged_anew"),
    Fault(
        "two processes log one dataset",
        "one waits for the other",
        f"{LOCK}::test_a_second_process_waits_until_the_first_is_gone",
    ),
    Fault(
        "two people log other results of one dataset to one store or one server, at gaps of 0 to 6 s",
        "every run is there, the last one of each as current",
        f"{LOCK}::test_two_writers_at_any_gap_leave_each_others_runs_whole",
    ),
    Fault(
        "a process dies with its lock on a server",
        "the next one on its machine breaks the lock",
        f"{LOCK}::test_a_lock_on_a_server_ends_with_its_process_where_it_ran",
    ),
    Fault(
        "a process dies with its lock on a server, and its machine with it",
        "the lock ends with its lease of half an hour",
        f"{LOCK}::test_a_lock_on_a_server_ends_with_its_lease",
    ),
    Fault(
        "the project was moved",
        "its artifacts are found",
        f"{ARTIFACTS}::test_a_moved_project_finds_its_artifacts",
    ),
    Fault(
        "the project was copied",
        "the original is never written to",
        f"{ARTIFACTS}::test_a_copy_never_writes_into_the_original",
    ),
]
