"""Tabulate the interval methods a dataset could have: which is chosen, which is deployed, and their scores on test."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from softkin.core.metrics.interval import fewest_commands
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.titles import Titles

#: What the paper puts around its model.
PAPERS_METHOD = "scp_mapie"
SCORES = ("coverage", "mean_width_mm", "winkler_mm", "winkler_without_gross_mm")
RATIO = "winkler_ratio_to_paper"


def interval_choice(candidates: Mapping[str, pd.DataFrame], metrics: pd.DataFrame) -> pd.DataFrame:
    """Candidates of every dataset, best first by `cv_winkler_typical_mm`, with their scores (mean over moving
    coordinates) on test and, by the method that each has `outside`, on extrapolation; the ratio of their Winkler score
    on test to that of the paper's recipe, where it was run; both also without gross errors.
    `extrapolation_assessable` says whether the `extrapolation_commands`, how many distinct ones there are, can tell a
    coverage.
    """
    mean = metrics[metrics["coordinate"] == "mean_informative"]
    key = ["dataset", "model", "preset", "interval_method", "confidence_level"]
    test, extrapolation = (
        mean[mean["subset"] == subset].set_index(key)[list(SCORES)].add_prefix(f"{subset}_")
        for subset in (TEST, EXTRAPOLATION)
    )
    n_commands = mean[mean["subset"] == EXTRAPOLATION].groupby("dataset")["n_commands"].first()
    frames = []
    for dataset, frame in candidates.items():
        scored = frame.assign(dataset=dataset).join(test, on=key)
        scored = scored.join(extrapolation, on=["outside" if name == "interval_method" else name for name in key])
        level = float(scored["confidence_level"].iloc[0])
        papers = (dataset, *PAPERS_RUN, PAPERS_METHOD, level)
        for ratio, score in ((RATIO, "test_winkler_mm"), (f"{RATIO}_without_gross", "test_winkler_without_gross_mm")):
            reference = float(test.loc[papers, score]) if papers in test.index else float("nan")
            scored[ratio] = scored[score] / reference
        scored["extrapolation_commands"] = int(n_commands[dataset])
        scored["extrapolation_assessable"] = int(n_commands[dataset]) >= fewest_commands(level)
        frames.append(scored[["dataset", *(name for name in scored if name != "dataset")]])
    return pd.concat(frames, ignore_index=True)


def chosen_intervals(choice: pd.DataFrame) -> pd.DataFrame:
    """The row of each dataset's chosen interval method, indexed by dataset."""
    return choice[choice["chosen"]].set_index("dataset", drop=False)


def deployed_intervals(choice: pd.DataFrame) -> pd.DataFrame:
    """The row of each dataset's deployed interval method, or of the chosen one where none is deployed; indexed by
    dataset.
    """
    candidates = choice[choice["deployed"] | choice["chosen"]].sort_values("deployed", ascending=False, kind="stable")
    return candidates.drop_duplicates("dataset").set_index("dataset", drop=False).loc[choice["dataset"].unique()]


def why_another_is_deployed(choice: pd.DataFrame, titles: Titles) -> dict[str, str]:
    """A sentence by dataset, for those whose deployed interval method is not the chosen one: which they are, and why.

    A chosen method that is not deployed is one on quantile regressors: it surrounds no point model.
    """
    chosen_ones = chosen_intervals(choice)
    sentences = {}
    for dataset, deployed in deployed_intervals(choice).iterrows():
        chosen = chosen_ones.loc[dataset]
        if chosen["deployed"]:
            continue
        chosen_text, deployed_text = (
            f"{titles.methods[row['interval_method']]} ({titles.run(row['model'], row['preset'])})"
            for row in (chosen, deployed)
        )
        outcome = (
            f"deployed is {deployed_text}, the best around the deployed model"
            if deployed["deployed"]
            else "none is deployed"
        )
        sentences[str(dataset)] = (
            f"Chosen is {chosen_text}, of the lowest typical Winkler score, cross-validated; it has quantile "
            f"regressors of its own and surrounds no point model, so {outcome}."
        )
    return sentences
