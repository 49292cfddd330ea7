"""Intervals out there that no ordinary method may give: they look at labels of the rows they are scored on, take them
in turn, or weigh by how new commands are spread. One file a method, one line here.
"""

from __future__ import annotations

from softkin.outside import adaptive, few_labels, fixed_weights, oracle, weighted
from softkin.outside.method import OutsideMethod

OUTSIDE_METHODS: dict[str, OutsideMethod] = {
    "oracle": oracle.METHOD,
    "few_labels": few_labels.METHOD,
    "few_labels_distance": few_labels.BY_DISTANCE,
    "adaptive": adaptive.METHOD,
    "weighted": weighted.METHOD,
    "fixed_weights": fixed_weights.METHOD,
}
