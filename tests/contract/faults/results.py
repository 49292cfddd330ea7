"""Faults of result files."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

RECORDS = "unit/core/test_job_records.py"
DAMAGE = "unit/core/test_damage.py"
ANEW = "named, and made anew by the next run"

FAULTS = [
    Fault(
        "a result was edited, cut off, swapped or deleted",
        "named with its job",
        f"{RECORDS}::test_edited_cut_swapped_and_deleted_files_are_named_with_their_job",
    ),
    Fault(
        "a result was edited, its size and time kept",
        "`make verify` names it",
        f"{RECORDS}::test_a_change_that_keeps_size_and_time_is_found_by_reading",
    ),
    Fault("`raw` was edited", ANEW, "workflow/test_damage.py::test_an_edited_file_and_a_deleted_model_are_made_anew"),
    Fault(
        "a model was deleted though all that was made from it is there",
        ANEW,
        "workflow/test_damage.py::test_an_edited_file_and_a_deleted_model_are_made_anew",
    ),
    Fault(
        "a seed was changed, and `.snakemake` was lost",
        "each job with other params is named, and done anew by the next run",
        "workflow/test_damage.py::test_what_had_other_params_is_made_anew_though_snakemakes_records_are_lost",
    ),
    Fault(
        "a damaged output is overlooked by Snakemake",
        "marked as unfinished",
        "unit/cli/test_redo.py::test_damaged_outputs_are_named_and_marked_as_snakemake_marks_them",
    ),
    Fault(
        "Parquet, joblib, JSON, CSV, TSV or NPZ is cut off",
        "one message that names the file",
        f"{DAMAGE}::test_the_damaged_one_among_sound_ones_is_named",
    ),
    Fault(
        "a table is cut off at the end of a value",
        "refused before it is read",
        f"{DAMAGE}::test_only_results_must_end_with_a_line_break",
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
        f"{RECORDS}::test_what_softkin_did_not_write_is_never_unpickled",
    ),
    Fault(
        "the record of a job names files elsewhere, or has other values than hashes",
        "it records nothing",
        f"{RECORDS}::test_a_record_of_files_elsewhere_or_of_other_values_is_none",
    ),
    Fault(
        "the record of a job is torn",
        "it records nothing; `make verify` says so",
        f"{RECORDS}::test_a_record_that_is_none_records_nothing",
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
]
