"""Which model of the pool each dataset gets: by the tuned cross-validation score on `train` alone."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd


def selection(scores: Mapping[tuple[str, str], float]) -> pd.DataFrame:
    """One row per dataset: the model of lowest cross-validated error, and the runner-up.

    `scores` is (dataset, model) -> cv_mae_mm. Ties go to the model that comes first in the registry.
    """
    frame = pd.DataFrame([(*key, score) for key, score in scores.items()], columns=["dataset", "model", "cv_mae_mm"])
    rows = []
    for dataset, pool in frame.groupby("dataset", sort=False):
        ranked = pool.sort_values("cv_mae_mm", kind="stable").reset_index(drop=True)
        second = ranked.loc[1] if len(ranked) > 1 else {"model": "", "cv_mae_mm": float("nan")}
        rows.append(
            {
                "dataset": dataset,
                "model": ranked.loc[0, "model"],
                "cv_mae_mm": ranked.loc[0, "cv_mae_mm"],
                "runner_up": second["model"],
                "runner_up_cv_mae_mm": second["cv_mae_mm"],
                "pool": " ".join(ranked["model"]),
            }
        )
    return pd.DataFrame(rows)
