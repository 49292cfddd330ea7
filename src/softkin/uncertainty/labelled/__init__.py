"""Registry of labelled methods: one file a method, one line here.

Unlike interval methods they may use true positions in extrapolation, take rows in turn, or weigh calibration rows by
the distribution of all new commands.
"""

from __future__ import annotations

from softkin.uncertainty.labelled import adaptive, few_labels, fixed_weights, oracle, weighted
from softkin.uncertainty.labelled.spec import LabelledMethod

LABELLED_METHODS: dict[str, LabelledMethod] = {
    "oracle": oracle.METHOD,
    "oracle_constant": oracle.CONSTANT,
    "few_labels": few_labels.METHOD,
    "few_labels_distance": few_labels.BY_DISTANCE,
    "adaptive": adaptive.METHOD,
    "weighted": weighted.METHOD,
    "fixed_weights": fixed_weights.METHOD,
}
