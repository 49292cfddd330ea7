from __future__ import annotations

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from softkin.uncertainty.calibration_data import Shell, ShellCalibration
from softkin.uncertainty.error_growth import new_distances
from softkin.uncertainty.intervals.rolling_shells import half_widths, intervals
from tests.unit.uncertainty.conftest import LEVELS, norm, shell_calibration, shells_with_growing_errors


def test_intervals_lie_around_the_deployed_model() -> None:
    data = shell_calibration(88)
    bounds, half = intervals(data, LEVELS), half_widths(data, LEVELS)
    np.testing.assert_allclose(bounds[..., 1] - bounds[..., 0], 2 * half)
    np.testing.assert_allclose(bounds.mean(axis=-1), np.broadcast_to(data.deployed.new, half.shape), atol=1e-9)


def test_intervals_cover_in_extrapolation_where_errors_grow_as_modelled() -> None:
    """100 robots: errors at distance 1 to 1.5 beyond `train` grow as in the shells."""
    shares = []
    for seed in range(100):
        rng = np.random.default_rng(1000 + seed)
        angles, radii = rng.uniform(0, 2 * np.pi, 100), rng.uniform(1.45, 2.0, 100)
        new = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
        data = shells_with_growing_errors(3.0, 5.0, new, seed)
        size = new_distances(data)[:, None] ** 5.0 * [1.0, 3.0]
        errors = rng.standard_normal((100, 2)) * size
        shares.append((np.abs(errors) <= half_widths(data, [0.9])[0]).mean())
    assert 0.9 < np.mean(shares) < 0.98


@settings(max_examples=40, deadline=None)
@given(
    start=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    angle=st.floats(0, 2 * np.pi),
    core_exponent=st.floats(-6, 6),
    slope=st.floats(-6, 8),
)
def test_intervals_never_narrow_along_a_ray_that_leaves_the_core(
    start: tuple[float, float], angle: float, core_exponent: float, slope: float
) -> None:
    steps = np.linspace(0, 6, 60)[:, None]
    ray = np.asarray(start) + steps * [np.cos(angle), np.sin(angle)]
    data = shells_with_growing_errors(core_exponent, slope, ray)
    farthest = norm(data.deployed.train_commands).max()
    assume(norm(ray[:1])[0] <= farthest)  # one that starts outside may come nearer first
    left = norm(ray) > farthest
    widths = half_widths(data, [0.8, 0.9])[:, left]
    assert len(widths[0])
    assert (np.diff(widths, axis=1) >= -1e-9 * widths[:, :-1]).all()
    assert (widths[1] >= widths[0]).all()


def test_a_shell_of_too_few_rows_is_ignored_and_without_any_the_interval_is_infinite() -> None:
    data = shells_with_growing_errors(1.0, 1.0, np.array([[2.0, 0.0]]))
    few = [Shell(s.core_commands, s.commands[:12], s.predicted[:12], s.truth[:12]) for s in data.shells]
    two = ShellCalibration(data.deployed, [*data.shells[:2], few[2]], data.norm)
    assert np.isfinite(half_widths(two, [0.8, 0.95])).all()
    none = half_widths(ShellCalibration(data.deployed, few, data.norm), [0.8, 0.95])
    assert np.isfinite(none[0]).all()
    assert np.isinf(none[1]).all()
