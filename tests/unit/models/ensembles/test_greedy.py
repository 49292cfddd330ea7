from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from softkin.models.ensembles.greedy import MOST_MEMBERS, N_STEPS, steps


def test_two_runs_that_err_to_either_side_share_the_weight_by_how_far() -> None:
    """Errors of +1 and -3: three parts to one are right everywhere."""
    truth = np.arange(12.0).reshape(4, 3)
    weights = steps(np.stack([truth + 1, truth - 3, truth + 9]), truth, np.full(4, 0.25))
    assert weights[0].tolist() == [1.0, 0.0, 0.0]
    assert weights[3].tolist() == [0.75, 0.25, 0.0]


@given(st.integers(0, 2**32 - 1), st.integers(1, 9))
def test_each_step_adds_one_run_to_those_before(seed: int, n_runs: int) -> None:
    rng = np.random.default_rng(seed)
    truth = rng.standard_normal((8, 2))
    weights = steps(truth + rng.standard_normal((n_runs, 8, 2)), truth, np.full(8, 1 / 8))
    counts = weights * np.arange(1, N_STEPS + 1)[:, None]
    added = np.diff(np.vstack([np.zeros(n_runs), counts]), axis=0)
    np.testing.assert_allclose(np.sort(added, axis=1)[:, -1], 1.0)
    np.testing.assert_allclose(np.abs(added).sum(axis=1), 1.0)
    assert (weights > 0).sum(axis=1).max() <= MOST_MEMBERS
