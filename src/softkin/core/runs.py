"""Runs: a model fitted with the parameters of a preset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

#: Where a model's parameters come from: the paper; a search for the lowest cross-validated error; a search for the
#: lowest error on outer shells of `train`.
PAPER, TUNED, OUTER = PRESETS = ("paper", "tuned", "outer")
#: The presets that a study stands behind.
SEARCHED = (TUNED, OUTER)
#: What the deployed run is chosen for, besides extrapolation alone.
INTERPOLATION, BOTH = "interpolation", "both"


class Run(NamedTuple):
    """One fitted model of a dataset: its name in the registry and the preset of its parameters."""

    model: str
    preset: str


#: The confidence level of the paper's intervals.
PAPERS_LEVEL = 0.9


def nearest_level(confidence_levels: Sequence[float]) -> float:
    """The configured level nearest to the paper's, at which methods are compared."""
    return min(confidence_levels, key=lambda level: abs(level - PAPERS_LEVEL))
