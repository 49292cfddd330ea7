"""Intervals out there that no ordinary method may give: they look at labels of the rows they are scored on, take them
in turn, or weigh by how new commands are spread. One file a method, one line here.
"""

from __future__ import annotations

from softkin.uncertainty.labelled import adaptive, few_labels, fixed_weights, oracle, weighted
from softkin.uncertainty.labelled.spec import LabelledMethod

LABELLED_METHODS: dict[str, LabelledMethod] = {
    "oracle": oracle.METHOD,
    "few_labels": few_labels.METHOD,
    "few_labels_distance": few_labels.BY_DISTANCE,
    "adaptive": adaptive.METHOD,
    "weighted": weighted.METHOD,
    "fixed_weights": fixed_weights.METHOD,
}
