"""What a headline says of the orientation of a robot's tip."""

from __future__ import annotations

import pandas as pd

from softkin.core.runs import nearest_level
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.reporting.tables.numbers import number_text, share_text


def orientation_sentences(scores: pd.DataFrame | None) -> list[str]:
    """A sentence for each dataset of orientation.csv; none where there is no such table."""
    if scores is None:
        return []
    level = nearest_level(sorted(set(scores["confidence_level"])))
    rows = scores[scores["confidence_level"] == level].set_index(["dataset", "subset"])
    sentences = []
    for dataset in rows.index.unique("dataset"):
        test, beyond = rows.loc[(dataset, TEST)], rows.loc[(dataset, EXTRAPOLATION)]
        errors = f"{number_text(test['mean_deg'])} degrees off on test, {number_text(beyond['mean_deg'])} beyond"
        held = f"{share_text(test['coverage'])} within {number_text(test['bound_deg'])} ({share_text(level, 0)})"
        sentences.append(f"{dataset}, orientation: {errors}; {held}.")
    return sentences
