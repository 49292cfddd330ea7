"""The interval method each robot gets, chosen on `validation`, and what it turned out to be worth."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.models.spec import PAPERS_RUN

#: What the paper puts around its model.
PAPERS_METHOD = "scp_mapie"
SHOWN = ("coverage", "mean_width_mm", "winkler_mm")


def given_intervals(choice: pd.DataFrame) -> pd.DataFrame:
    """The row of each dataset's calibrated model, which is not the chosen one where that has a learner of its own; the
    chosen one where no candidate is deployed. Indexed by dataset.
    """
    shown = choice[choice["deployed"] | choice["chosen"]].sort_values("deployed", ascending=False, kind="stable")
    return shown.drop_duplicates("dataset").set_index("dataset", drop=False).loc[choice["dataset"].unique()]


def interval_choice(candidates: Mapping[str, pd.DataFrame], metrics: pd.DataFrame) -> pd.DataFrame:
    """Candidates of every dataset, best first by `cv_winkler_mm`, with their scores (mean over moving coordinates) on
    test and, by the method that each has `outside`, on extrapolation; and the ratio of their Winkler score on test to
    that of the paper's recipe, where it was run.
    """
    mean = metrics[metrics["coordinate"] == "mean_informative"]
    key = ["dataset", "model", "preset", "interval_method", "confidence_level"]
    test, beyond = (
        mean[mean["subset"] == subset].set_index(key)[list(SHOWN)].add_prefix(f"{subset}_")
        for subset in (TEST, EXTRAPOLATION)
    )
    frames = []
    for dataset, frame in candidates.items():
        mine = frame.assign(dataset=dataset).join(test, on=key)
        mine = mine.join(beyond, on=["outside" if name == "interval_method" else name for name in key])
        level = float(mine["confidence_level"].iloc[0])
        papers = (dataset, *PAPERS_RUN, PAPERS_METHOD, level)
        reference = float(test.loc[papers, "test_winkler_mm"]) if papers in test.index else float("nan")
        mine["winkler_ratio_to_paper"] = mine["test_winkler_mm"] / reference
        frames.append(mine[["dataset", *(name for name in mine if name != "dataset")]])
    return pd.concat(frames, ignore_index=True)
