"""What a labelled method declares of itself holds for the entries of the registry."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.labelled import LABELLED_METHODS
from tests.unit.uncertainty.conftest import LEVELS
from tests.unit.uncertainty.labelled.conftest import labelled


@pytest.mark.parametrize("method", LABELLED_METHODS)
def test_every_method_answers_in_one_shape_and_levels_are_nested(method: str) -> None:
    answer = LABELLED_METHODS[method].answer(labelled(), LEVELS, 0)
    assert LABELLED_METHODS[method].name == method
    assert answer.half_widths.shape == (3, len(answer.scored), 3)
    assert set(answer.scored) <= set(range(200))
    assert list(answer.refused) == [""] * 3
    if method != "adaptive":  # each level adapts by itself
        assert (np.diff(answer.half_widths, axis=0) >= 0).all()


@pytest.mark.parametrize(
    "method", [pytest.param("oracle", marks=pytest.mark.slow), "few_labels", "few_labels_distance", "weighted"]
)
def test_coverage_in_domain_is_what_is_guaranteed(method: str) -> None:
    """300 draws in which new rows are like the calibration rows."""
    shares = []
    for seed in range(300 if method != "weighted" else 60):
        rows = labelled(seed=seed)
        answer = LABELLED_METHODS[method].answer(rows, LEVELS, seed)
        shares.append((np.abs(rows.errors[answer.scored]) <= answer.half_widths).mean(axis=(1, 2)))
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(len(shares))
    for level, mean, error in zip(LEVELS, means, errors, strict=True):
        assert level - 4 * error - 1e-9 <= mean <= level + 0.06
