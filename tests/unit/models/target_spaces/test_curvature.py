"""Positions -> arcs -> positions: markers that move, that never do, and that only tremble."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.models import MODELS
from softkin.models.target_spaces.curvature import CurvatureCoordinates
from softkin.training.fit import fit_quietly, kinematic_model
from tests.conftest import bending_arm


def trembling_arm(size: float) -> Samples:
    """An arm whose base trembles by `size` (mm) along z, in proportion to its first command."""
    samples = bending_arm(80, n_markers=3)
    positions = samples.positions.copy()
    positions[:, 2] = size * samples.commands[:, 0]
    return Samples(samples.commands, positions)


@pytest.mark.parametrize("size", [0.0, 1e-37, 1e-9])
def test_what_trembles_comes_back_and_what_rests_is_no_target(size: float) -> None:
    samples = trembling_arm(size)
    space = CurvatureCoordinates().fit(samples.positions, samples.commands)
    targets = space.transform(samples.positions)
    moving = CurvatureCoordinates().fit(bending_arm(80, n_markers=3).positions, samples.commands)
    assert targets.shape[1] == moving.n_arcs_ + (size > 0)
    back = space.inverse_transform(targets)
    np.testing.assert_allclose(back[:, 3:], samples.positions[:, 3:], atol=1e-8)
    np.testing.assert_allclose(back[:, :3], samples.positions[:, :3], rtol=1e-9, atol=1e-9 * size)
    spread = space.inverse_spread(targets, np.ones_like(targets))
    assert (spread[:, :2] == 0).all()
    np.testing.assert_allclose(spread[:, 2], samples.positions[:, 2].std(), rtol=1e-9, atol=0)
    assert (spread[:, 3:] > 0).all()


def test_a_model_in_arcs_predicts_what_trembles_as_one_in_positions_does() -> None:
    """R2 over all coordinates, as the paper has it, counts it."""
    samples = trembling_arm(1e-37)
    estimator = kinematic_model(
        MODELS["lr"], {"degree": 1}, skip_constant=True, seed=0, threads=1, target_space="curvature"
    )
    fit_quietly(estimator, samples, 1)
    np.testing.assert_allclose(
        estimator.predict(samples.commands)[:, 2], samples.positions[:, 2], rtol=1e-6, atol=1e-43
    )
