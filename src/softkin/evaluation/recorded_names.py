"""Names in the table of scores in time: its splits, its methods, its columns. It imports nothing."""

from __future__ import annotations

#: What a model is scored on: the published subsets, a session that it never saw, and later rows of a recording.
PUBLISHED, NEXT_SESSION, LATER = "published", "next_session", "later"
#: Splits of the rows by session or by block of time, so that a mean over all hides none.
BLOCKS = {name: f"{name}_in_parts" for name in (PUBLISHED, NEXT_SESSION, LATER)}
#: Kinds of intervals.
PLAIN, RECALIBRATED, FIRST_POSES = "split conformal", "recalibrated", "recalibrated on the first poses"
ADAPTIVE, FIXED_WEIGHTS = "adaptive", "fixed weights"
COLUMNS = ["dataset", "split", "model", "preset", "memory", "subset", "method", "rmse_mm", "mae_mm", "coverage"]
COLUMNS += ["mean_width_mm", "winkler_mm", "n_recalibration_poses"]
