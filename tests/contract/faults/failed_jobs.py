"""Faults of jobs that fail while others go on."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

PLAN = "unit/cli/test_partial_tables.py"
FAILS = "workflow/test_failed_parts.py::test_a_dataset_a_model_and_a_method_that_fail_take_the_tables_of_nothing_else"
REST = "tables and report of the rest, with a caution that names it; the run counts as failed"
OF_OTHERS = "tables and report of the other datasets, with a caution that names it; the run counts as failed"

FAULTS = [
    Fault("a dataset cannot be retrieved", REST, FAILS),
    Fault("a model cannot be fitted", REST, FAILS),
    Fault("an interval method raises", REST, FAILS),
    Fault("a job of a dataset fails, and nobody knows on what", OF_OTHERS,
          f"{PLAN}::test_a_dataset_is_left_out_where_nobody_knows_what_it_could_do_without"),
    Fault("the last model, or the last interval method, of a dataset fails", OF_OTHERS,
          f"{PLAN}::test_a_dataset_is_left_out_where_no_model_or_no_method_is_left"),
]  # fmt: skip
