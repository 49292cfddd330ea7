from __future__ import annotations

import numpy as np

from softkin.uncertainty.labelled.few_labels import BY_DISTANCE, N_LABELS, answer
from tests.unit.uncertainty.conftest import LEVELS, norm, rank
from tests.unit.uncertainty.labelled.conftest import labelled


def test_labels_are_drawn_by_the_seed_and_never_scored() -> None:
    rows = labelled()
    one, same, other = (answer(rows, LEVELS, seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.half_widths, same.half_widths)
    assert len(one.scored) == 200 - N_LABELS
    assert set(one.scored) != set(other.scored)
    labels = np.setdiff1d(np.arange(200), one.scored)
    expected = np.sort(np.abs(rows.errors[labels]), axis=0)[rank(N_LABELS, 0.9) - 1]
    np.testing.assert_array_equal(one.half_widths[1], np.broadcast_to(expected, (180, 3)))


def test_by_distance_intervals_widen_outwards() -> None:
    rows = labelled(norms=(1.0, 2.0))
    wider = BY_DISTANCE.answer(rows, LEVELS, 0)
    outwards = np.argsort(norm(rows.commands[wider.scored]))
    assert wider.half_widths[1, outwards[-1], 0] > 1.5 * wider.half_widths[1, outwards[0], 0]


def test_no_more_rows_than_labels_are_refused() -> None:
    refused = answer(labelled(m=N_LABELS), LEVELS, 0)
    assert len(refused.scored) == 0
    assert refused.half_widths.shape == (3, 0, 3)
    assert all("20 rows, of which 20" in reason for reason in refused.refused)
