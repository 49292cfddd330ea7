"""Audit of a dataset before anything is fitted to it. One file a check, one line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from softkin.core.samples import Samples
from softkin.data.audit import (
    ambiguous_commands,
    constant_columns,
    copied_commands,
    duplicate_rows,
    extrapolation_support,
    few_calibration_blocks,
    few_calibration_rows,
    few_commands,
    gross_outliers,
    memory,
    near_copies,
    stuck_poses,
    subset_shift,
    suspicious_columns,
    swapped_markers,
)
from softkin.data.audit.findings import CheckResult

#: check(samples of all four subsets, positions in mm) -> findings and numbers; in the order of the card.
CHECKS: dict[str, Callable[[Mapping[str, Samples]], CheckResult]] = {
    "suspicious_columns": suspicious_columns.check,
    "swapped_markers": swapped_markers.check,
    "copied_commands": copied_commands.check,
    "near_copies": near_copies.check,
    "few_commands": few_commands.check,
    "few_calibration_rows": few_calibration_rows.check,
    "few_calibration_blocks": few_calibration_blocks.check,
    "duplicate_rows": duplicate_rows.check,
    "constant_columns": constant_columns.check,
    "stuck_poses": stuck_poses.check,
    "gross_outliers": gross_outliers.check,
    "extrapolation_support": extrapolation_support.check,
    "subset_shift": subset_shift.check,
    "ambiguous_commands": ambiguous_commands.check,
    "memory": memory.check,
}
