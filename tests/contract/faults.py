"""Faults that softkin survives: what happens, and the test that shows it. docs/faults.md is made from this table."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """`what` goes wrong and what `happens` then, in words; `test`, below tests/, as file::name."""

    what: str
    happens: str
    test: str


_JOURNAL, _STUDY = "unit/training/test_journal.py", "unit/training/test_study.py"
_RECORDS, _DAMAGE, _ONE_RUN = "unit/core/test_job_records.py", "unit/core/test_damage.py", "unit/cli/test_one_run.py"
_CAMPAIGN, _PROCESS = "unit/cli/test_campaign.py", "unit/cli/test_workflow_process.py"
_STORE, _OPEN, _LOCK = "unit/tracking/test_store.py", "unit/tracking/test_open_store.py", "unit/tracking/test_lock.py"
_ARTIFACTS, _MODELS = "unit/tracking/test_artifacts.py", "unit/tracking/test_models.py"
_RETRIEVE, _DOWNLOAD = "unit/data/test_retrieve.py", "unit/data/test_download.py"
_KILLS = "workflow/test_kills.py::test_a_run_that_was_killed_ends_as_an_undisturbed_one"
_BAD = "contract/test_bad_inputs.py::test_a_bad_input_has_one_message_with_place_and_fix"
_NO_STORE = f"{_OPEN}::test_what_is_no_usable_store_is_named_with_its_fix_and_left_as_it_is"

ANEW = "named, and made anew by the next run"
ENDS_EQUAL = "the next plain run finishes, with the tables of an undisturbed one"

FAULTS: dict[str, list[Fault]] = {
    "Runs that are killed": [
        Fault("`kill -9` of Snakemake at any moment", ENDS_EQUAL, _KILLS),
        Fault("`kill -9` of a job", ENDS_EQUAL, _KILLS),
        Fault("`kill -9` of Snakemake and its jobs at once, a power cut", ENDS_EQUAL, _KILLS),
        Fault("the terminal is closed (SIGHUP)", ENDS_EQUAL, _KILLS),
        Fault("killed while data are retrieved", ENDS_EQUAL, _KILLS),
        Fault("killed while runs are logged", f"{ENDS_EQUAL}, each run once", _KILLS),
        Fault(
            "a campaign is killed half-way",
            "the next one ends with 0",
            "workflow/test_campaign.py::test_five_nights_in_a_row",
        ),
        Fault(
            "SIGTERM, SIGINT or SIGHUP to a campaign",
            "it ends with all its jobs, also deaf ones",
            f"{_PROCESS}::test_a_signal_ends_the_workflow_with_its_jobs",
        ),
        Fault(
            "a campaign was stopped",
            "the verdict says by which signal",
            f"{_CAMPAIGN}::test_a_campaign_that_was_stopped_says_by_what",
        ),
        Fault(
            "the lock, the jobs and the half files of a killed run are left",
            "cleared, and said",
            f"{_ONE_RUN}::test_what_a_killed_run_left_is_cleared_and_named",
        ),
        Fault(
            "an orphan that ignores SIGTERM",
            "ended by force",
            f"{_ONE_RUN}::test_a_process_that_does_not_listen_is_ended_by_force",
        ),
        Fault(
            "a note of who runs is torn",
            "nobody is held up",
            f"{_ONE_RUN}::test_what_a_killed_run_noted_of_itself_holds_nobody_up",
        ),
        Fault(
            "the count of jobs is torn",
            "unknown, and the campaign goes on",
            f"{_PROCESS}::test_a_count_that_was_torn_by_a_kill_is_unknown",
        ),
        Fault(
            "everything is redone, and that fails",
            "the studies from before come back",
            f"{_PROCESS}::test_studies_start_anew_and_come_back_where_the_workflow_fails",
        ),
    ],
    "Studies": [
        Fault(
            "a study is killed between any two writes",
            "it ends with the same trials",
            f"{_JOURNAL}::test_a_study_killed_between_any_two_writes_ends_as_an_undisturbed_one",
        ),
        Fault(
            "a study is killed in a trial",
            "it ends with the same trials",
            f"{_STUDY}::test_a_killed_study_ends_as_an_undisturbed_one",
        ),
        Fault(
            "the last record is torn at any byte",
            "cut off, and the study goes on",
            f"{_JOURNAL}::test_a_last_record_torn_at_any_byte_heals",
        ),
        Fault(
            "the last line is garbage",
            "cut off, and the study goes on",
            f"{_JOURNAL}::test_a_last_line_that_is_no_record_heals",
        ),
        Fault(
            "the file is no journal",
            "replaced, and the log says so",
            f"{_JOURNAL}::test_a_file_that_is_no_journal_is_replaced_and_the_log_says_so",
        ),
        Fault(
            "the file is the journal of another study",
            "replaced, and the log says so",
            f"{_JOURNAL}::test_the_journal_of_another_study_is_replaced_and_the_log_says_so",
        ),
        Fault(
            "a killed process has left its lock",
            "nobody is held up",
            f"{_JOURNAL}::test_a_lock_that_a_killed_process_left_holds_nobody_up",
        ),
        Fault("the seed changed", "a new study", f"{_STUDY}::test_another_seed_starts_a_new_study"),
        Fault("Optuna refuses a study", "one message with its fix", _BAD),
    ],
    "Results": [
        Fault(
            "a result was edited, cut off, swapped or deleted",
            "named with its job",
            f"{_RECORDS}::test_edited_cut_swapped_and_deleted_files_are_named_with_their_job",
        ),
        Fault(
            "a result was edited, its size and time kept",
            "`make verify` names it",
            f"{_RECORDS}::test_a_change_that_keeps_size_and_time_is_found_by_reading",
        ),
        Fault(
            "`raw` was edited", ANEW, "workflow/test_damage.py::test_an_edited_file_and_a_deleted_model_are_made_anew"
        ),
        Fault(
            "a model was deleted though all that was made from it is there",
            ANEW,
            "workflow/test_damage.py::test_an_edited_file_and_a_deleted_model_are_made_anew",
        ),
        Fault(
            "a damaged output is overlooked by Snakemake",
            "marked as unfinished",
            "unit/cli/test_redo.py::test_damaged_outputs_are_named_and_marked_as_snakemake_marks_them",
        ),
        Fault(
            "Parquet, joblib, JSON, CSV, TSV or NPZ is cut off",
            "one message that names the file",
            f"{_DAMAGE}::test_the_damaged_one_among_sound_ones_is_named",
        ),
        Fault(
            "a table is cut off at the end of a value",
            "refused before it is read",
            f"{_DAMAGE}::test_only_results_must_end_with_a_line_break",
        ),
        Fault(
            "JSON is empty, cut off or says a key twice",
            "one message that names the file",
            "unit/core/test_files.py::test_a_damaged_result_is_named_with_what_to_do",
        ),
        Fault(
            "an input of a job is garbage",
            "it is the message; the traceback is in the log",
            "unit/core/test_job.py::test_a_damaged_input_is_the_message_and_the_traceback_is_in_the_log",
        ),
        Fault(
            "a model was brought in from elsewhere",
            "never unpickled",
            f"{_RECORDS}::test_what_softkin_did_not_write_is_never_unpickled",
        ),
        Fault(
            "the record of a job is torn",
            "it records nothing; `make verify` says so",
            f"{_RECORDS}::test_a_record_that_is_none_records_nothing",
        ),
        Fault(
            "a number in a table was edited",
            "`make verify` names it",
            "unit/cli/test_recompute.py::test_one_edited_number_is_named",
        ),
        Fault(
            "data were edited after they were retrieved",
            "refused when they are read",
            "unit/data/test_prepare.py::test_a_file_that_was_changed_since_it_was_retrieved_is_refused",
        ),
        Fault(
            "a write is interrupted",
            "the old file or the new one, never half of one",
            "unit/core/test_files.py::test_a_file_appears_whole_or_not_at_all",
        ),
        Fault(
            "the power fails after a write",
            "what has its name is on the disk",
            "unit/core/test_files.py::test_a_file_is_on_the_disk_before_it_takes_its_name",
        ),
    ],
    "The machine": [
        Fault("the disk is full", "one message that names the file; what is finished is kept", _BAD),
        Fault("a folder may not be written", "one message that names it", _BAD),
        Fault("the memory is used up", "one message with its fix", _BAD),
        Fault(
            "the clock jumps ahead or back",
            "results stay what their content is",
            f"{_RECORDS}::test_clocks_that_jump_and_files_dated_in_the_future_are_no_damage",
        ),
        Fault(
            "files are dated in the future",
            "results stay what their content is",
            f"{_RECORDS}::test_clocks_that_jump_and_files_dated_in_the_future_are_no_damage",
        ),
        Fault(
            "the clock was set back during a campaign",
            "the verdict still says why",
            f"{_CAMPAIGN}::test_a_clock_that_was_set_back_takes_no_reason_away",
        ),
        Fault(
            "two runs in one folder",
            "the second is told who runs since when",
            f"{_ONE_RUN}::test_a_second_run_is_told_who_runs_since_when",
        ),
        Fault(
            "two campaigns in one folder",
            "the second ends with 75",
            f"{_CAMPAIGN}::test_a_second_campaign_is_told_who_runs_one_since_when",
        ),
        Fault(
            "the lock is held and its note torn",
            "the second ends with 75",
            f"{_CAMPAIGN}::test_a_torn_note_of_who_holds_the_lock_is_no_traceback",
        ),
        Fault(
            "the pipe of the output is closed",
            "the run goes on",
            "unit/cli/watching/test_view.py::test_a_closed_pipe_does_not_stop_the_run",
        ),
        Fault("the port of the UI is taken", "one sentence", "unit/cli/test_ui.py::test_a_busy_port_is_one_sentence"),
    ],
    "The MLflow store": [
        Fault(
            "it is lost",
            "one message; `make store` makes it again",
            f"{_STORE}::test_a_lost_store_is_an_error_with_a_fix",
        ),
        Fault(
            "four processes make it at once",
            "it is made once",
            f"{_STORE}::test_four_processes_may_create_the_store_at_once",
        ),
        Fault("an experiment was deleted", "restored", f"{_STORE}::test_a_deleted_experiment_comes_back"),
        Fault(
            "it is locked for a minute", "waited for, up to two minutes", f"{_OPEN}::test_a_locked_store_is_waited_for"
        ),
        Fault(
            "it stays locked",
            "one message that names the file",
            f"{_OPEN}::test_a_store_that_stays_locked_is_one_sentence",
        ),
        Fault(
            "it may not be written",
            "one message that names the file",
            f"{_OPEN}::test_a_store_that_may_not_be_written_says_so",
        ),
        Fault(
            "it lies on a file system that is read-only",
            "one message that names the file",
            f"{_OPEN}::test_sqlites_own_word_for_it_is_the_same",
        ),
        Fault("a text file or a picture is in its place", "one message; the file is left as it is", _NO_STORE),
        Fault("a folder is in its place", "one message; the folder is left as it is", _NO_STORE),
        Fault("the database of another program is in its place", "one message; it is left as it is", _NO_STORE),
        Fault("an older MLflow made it", "one message with the command that brings it up to date", _NO_STORE),
        Fault("a newer MLflow made it", "one message; it is left as it is", _NO_STORE),
        Fault("it is cut in half or overwritten", "one message; it is left as it is", _NO_STORE),
        Fault(
            "its file is empty",
            "it becomes a store",
            f"{_OPEN}::test_an_empty_file_is_none_yet_and_mlflow_makes_one_of_it",
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
            f"{_CAMPAIGN}::test_a_store_that_cannot_be_used_is_a_verdict",
        ),
        Fault(
            "MLflow fails when a campaign is judged",
            "the verdict says so",
            f"{_CAMPAIGN}::test_an_error_of_mlflow_is_a_verdict_and_a_defect_is_not",
        ),
        Fault(
            "a run was cut off while it was logged",
            "removed and made again",
            f"{_MODELS}::test_a_run_cut_off_before_its_end_is_removed_and_made_again",
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
        Fault("artifacts are lost", "logged anew", f"{_MODELS}::test_artifacts_that_are_gone_are_logged_anew"),
        Fault(
            "two processes log one dataset",
            "one waits for the other",
            f"{_LOCK}::test_a_second_process_waits_until_the_first_is_gone",
        ),
        Fault(
            "a process dies with its lock on a server",
            "the lock ends with its lease",
            f"{_LOCK}::test_a_lock_on_a_server_ends_with_its_lease",
        ),
        Fault(
            "the project was moved",
            "its artifacts are found",
            f"{_ARTIFACTS}::test_a_moved_project_finds_its_artifacts",
        ),
        Fault(
            "the project was copied",
            "the original is never written to",
            f"{_ARTIFACTS}::test_a_copy_never_writes_into_the_original",
        ),
    ],
    "Downloads": [
        Fault(
            "the connection is refused",
            "named, and the next source is tried",
            f"{_RETRIEVE}::test_a_refused_connection_is_named",
        ),
        Fault("a server fails and recovers", "tried again", f"{_RETRIEVE}::test_a_source_that_recovers_is_tried_again"),
        Fault("a byte now and then", "given up", f"{_DOWNLOAD}::test_a_byte_now_and_then_is_no_progress"),
        Fault("a packed body is cut off", "no file", f"{_DOWNLOAD}::test_a_packed_body_that_is_cut_off_is_no_file"),
        Fault(
            "a wrong file comes", "the right one stays", f"{_RETRIEVE}::test_a_wrong_file_does_not_replace_a_right_one"
        ),
        Fault(
            "all sources are out of reach",
            "a stand-in with its reason, until they return",
            "workflow/test_stand_ins.py::test_a_stand_in_takes_the_place_of_unreachable_data_until_they_return",
        ),
    ],
    "Telling somebody": [
        Fault(
            "a notification fails",
            "said; the exit code is that of the campaign",
            "unit/cli/test_notification.py::test_every_url_gets_the_verdict_and_one_that_fails_is_said",
        ),
        Fault(
            "there are URLs, and Apprise is not installed",
            "one message before anything is computed",
            "unit/cli/test_notification.py::test_urls_without_apprise_are_an_error_that_shows_none",
        ),
    ],
}
