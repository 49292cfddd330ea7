from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ShellCalibration
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.intervals.shell import MATCHED, METHOD
from softkin.uncertainty.intervals.spec import IntervalMethod
from tests.unit.uncertainty.conftest import LEVELS, shell_calibration


def half_by_hand(data: ShellCalibration, place: int, level: float) -> Array:
    shell = data.shells[place]
    scores = np.sort(np.abs(shell.truth - shell.predicted), axis=0)
    rank = conformal_rank(len(scores), level)
    assert rank is not None
    return np.asarray(scores[rank - 1])


@pytest.mark.parametrize("method", [METHOD, MATCHED])
def test_a_shell_sets_one_width_around_the_deployed_model(method: IntervalMethod[ShellCalibration]) -> None:
    data = shell_calibration(88)
    bounds = method.intervals(data, LEVELS)
    np.testing.assert_allclose(bounds.mean(axis=-1), np.broadcast_to(data.deployed.new, bounds.shape[:-1]))
    shares = [len(s.core_commands) / (len(s.core_commands) + len(s.commands)) for s in data.shells]
    radius = data.norm(data.deployed.train_commands).max()
    beyond = data.norm(data.deployed.new_commands).max() / radius
    ratios = [radius / data.norm(s.core_commands).max() for s in data.shells]
    place = int(np.argmin(np.abs(np.subtract(shares, 0.7)) if method is METHOD else np.abs(np.log(ratios / beyond))))
    for level, of_level in zip(LEVELS, bounds, strict=True):
        expected = np.broadcast_to(2 * half_by_hand(data, place, level), of_level.shape[:-1])
        np.testing.assert_allclose(of_level[..., 1] - of_level[..., 0], expected)


def test_the_matched_shell_follows_the_new_commands() -> None:
    """The farther out they lie, the smaller the core whose shell is taken."""
    data = shell_calibration(88)
    widths = []
    for factor in (1.0, 3.0):
        deployed = replace(data.deployed, new_commands=factor * data.deployed.new_commands)
        bounds = MATCHED.intervals(replace(data, deployed=deployed), [0.9])
        widths.append(bounds[0, 0, :, 1] - bounds[0, 0, :, 0])
    expected = [2 * half_by_hand(data, place, 0.9) for place in (2, 0)]
    np.testing.assert_allclose(widths, expected)
