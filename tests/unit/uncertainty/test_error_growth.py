from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Evidence, Shell, ShellEvidence
from softkin.uncertainty.error_growth import Growth, growth_laws, law, new_distances
from softkin.uncertainty.intervals.rolling_shells import half_widths


def norm(rows: Array) -> Array:
    return np.asarray(np.linalg.norm(rows, axis=1))


def law_abiding(by_reach: float, by_distance: float, new: Array, seed: int = 0) -> ShellEvidence:
    """Errors that follow a law, the second coordinate three times those of the first."""
    rng = np.random.default_rng(seed)
    train = rng.uniform(-1, 1, (600, 2))
    norms = norm(train)
    shells = []
    for radius in (0.5, 0.7, 0.9):
        core, commands = train[norms <= radius], train[norms > radius]
        reach = norm(core).max() / norms.max()
        size = reach**by_reach * (norm(commands) / norm(core).max()) ** by_distance
        errors = rng.standard_normal((len(commands), 2)) * size[:, None] * [1.0, 3.0]
        shells.append(Shell(core, commands, errors, np.zeros_like(errors)))
    nothing = np.zeros((len(new), 2))
    return ShellEvidence(
        Evidence(np.zeros((50, 2)), np.zeros((50, 2)), nothing, None, None, None, train, None, new), shells, norm
    )


def test_the_law_is_found_that_the_errors_follow() -> None:
    evidence = law_abiding(3.0, 5.0, np.zeros((1, 2)))
    for found in growth_laws(evidence):
        np.testing.assert_allclose(found.reach, 3.0, atol=1.0)
        one, three = (np.log(found.of_shell(1.0, np.exp([x]))[0]) for x in (0.1, 0.3))
        np.testing.assert_allclose((three - one) / 0.2, 5.0, atol=1.5)


def test_a_bent_law_is_found_and_goes_on_as_steeply_as_it_got_there() -> None:
    """A polynomial's errors grow as Chebyshev's, not as a power: cosh(n arccosh(distance))."""
    train = np.random.default_rng(0).uniform(-1, 1, (2000, 2))
    norms, shells = norm(train), []
    for radius in (0.6, 0.8, 1.0):
        core, commands = train[norms <= radius], train[norms > radius]
        distances = norm(commands) / norm(core).max()
        errors = np.cosh(6 * np.arccosh(distances))[:, None] * [1.0, 1.0]
        shells.append(Shell(core, commands, errors, np.zeros_like(errors)))
    new = np.array([[1.45, 0.0]])
    evidence = ShellEvidence(
        Evidence(np.zeros((50, 2)), np.zeros((50, 2)), np.zeros((1, 2)), None, None, None, train, None, new),
        shells,
        norm,
    )
    for found in growth_laws(evidence):
        assert (found.bend < 0).all()
        grown = np.log(found.of_shell(1.0, np.array([1.1, 1.5]))[:, 0])
        true = 6 * np.arccosh([1.1, 1.5])
        assert grown[1] - grown[0] == pytest.approx(true[1] - true[0], abs=0.7)
        steps = np.log(found.of_shell(1.0, np.exp(found.farthest + np.array([-1e-6, 0.0, 1e-6]))))[:, 0]
        assert steps[2] - steps[1] == pytest.approx(steps[1] - steps[0], rel=1e-3)
        assert steps[2] > steps[1]


def test_intervals_cover_outside_where_errors_follow_a_law() -> None:
    """300 robots: errors at distance 1 to 1.5 beyond `train` follow the same law as in the shells."""
    shares = []
    for seed in range(300):
        rng = np.random.default_rng(1000 + seed)
        angles, radii = rng.uniform(0, 2 * np.pi, 100), rng.uniform(1.45, 2.0, 100)
        new = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
        evidence = law_abiding(3.0, 5.0, new, seed)
        size = new_distances(evidence)[:, None] ** 5.0 * [1.0, 3.0]
        errors = rng.standard_normal((100, 2)) * size
        shares.append((np.abs(errors) <= half_widths(evidence, [0.9])[0]).mean())
    assert 0.9 < np.mean(shares) < 0.98


def test_a_model_is_never_taken_for_better_than_the_best_that_was_seen() -> None:
    nothing = np.zeros(2)
    one = Growth(np.array([-4.0, 4.0]), np.array([2.0, 0.0]), nothing, largest=0.5, farthest=0.1)
    np.testing.assert_allclose(one.of_shell(0.5, np.array([1.0, 2.0])), [[16.0, 1 / 16], [64.0, 1 / 16]])
    np.testing.assert_allclose(one.of_new(np.array([1.0, 2.0])), [[16.0, 1.0], [64.0, 1.0]])


def test_errors_that_shrink_with_the_distance_are_taken_for_constant() -> None:
    log_reaches = np.repeat([-1.0, -0.5], 50)
    log_distances = np.tile(np.linspace(0.01, 0.5, 50), 2)
    errors = np.exp(2 * log_reaches - 3 * log_distances)
    by_reach, by_distance, bend = law(errors, log_reaches, log_distances, np.ones(100))
    assert by_distance == bend == 0.0
    assert by_reach == pytest.approx(2.0)


@settings(max_examples=40, deadline=None)
@given(
    start=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    angle=st.floats(0, 2 * np.pi),
    by_reach=st.floats(-6, 6),
    by_distance=st.floats(-6, 8),
)
def test_intervals_never_narrow_along_a_ray_that_leaves_the_core(
    start: tuple[float, float], angle: float, by_reach: float, by_distance: float
) -> None:
    steps = np.linspace(0, 6, 60)[:, None]
    ray = np.asarray(start) + steps * [np.cos(angle), np.sin(angle)]
    evidence = law_abiding(by_reach, by_distance, ray)
    left = norm(ray) > norm(evidence.deployed.train_commands).max()  # type: ignore[arg-type]
    widths = half_widths(evidence, [0.8, 0.9])[:, left]
    assert len(widths[0])
    assert (np.diff(widths, axis=1) >= -1e-9 * widths[:, :-1]).all()
    assert (widths[1] >= widths[0]).all()


def test_a_shell_of_too_few_rows_has_no_say_and_without_any_the_interval_is_infinite() -> None:
    evidence = law_abiding(1.0, 1.0, np.array([[2.0, 0.0]]))
    few = [Shell(s.core_commands, s.commands[:12], s.predicted[:12], s.truth[:12]) for s in evidence.shells]
    two = ShellEvidence(evidence.deployed, [*evidence.shells[:2], few[2]], evidence.norm)
    assert np.isfinite(half_widths(two, [0.8, 0.95])).all()
    none = half_widths(ShellEvidence(evidence.deployed, few, evidence.norm), [0.8, 0.95])
    assert np.isfinite(none[0]).all()
    assert np.isinf(none[1]).all()


def test_gross_errors_do_not_bend_the_law() -> None:
    """1 % of rows stuck in another pose, 1000 times off, anywhere in the shells."""
    rng = np.random.default_rng(5)
    log_reaches, log_distances = np.log(rng.choice([0.6, 0.7, 0.8, 0.9], 1000)), rng.uniform(0, 0.4, 1000)
    errors = np.abs(rng.standard_normal(1000)) * np.exp(2 * log_reaches + 6 * log_distances)
    clean = law(errors, log_reaches, log_distances, np.ones(1000))
    errors[rng.choice(1000, 10, replace=False)] *= 1000
    gross = law(errors, log_reaches, log_distances, np.ones(1000))

    def grown(found: tuple[float, float, float]) -> float:
        return found[1] * 0.4 + found[2] * 0.4**2

    assert grown(clean) == pytest.approx(6 * 0.4, abs=0.3)
    assert grown(gross) == pytest.approx(grown(clean), abs=0.3)
    assert gross[0] == pytest.approx(clean[0], abs=0.7)
