"""What every interval method of the registry must do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import CalibrationData, PointCalibration
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import GUARANTEES, MARGINAL, NO_GUARANTEE, WEAK, IntervalMethod
from tests.contract import laws
from tests.contract.calibration import LEVELS, MAKERS, N_COORDINATES, N_NEW, calibration_data

Method = IntervalMethod[Any]
#: What a method that is marginal at 1 - 2 alpha covers at least.
LEAST = {MARGINAL: lambda level: level, WEAK: lambda level: 2 * level - 1}
N_DRAWS = 20


def is_named(name: str, method: Method) -> None:
    laws.has_name_and_title(name, method)
    assert method.guarantee in GUARANTEES
    assert issubclass(method.calibrated_on, CalibrationData)
    assert method.calibrated_on in MAKERS
    assert method.guarantee != MARGINAL or method.rank is not None


def has_ordered_bounds_for_each_level_row_and_coordinate(_name: str, method: Method) -> None:
    data, _ = calibration_data(method.calibrated_on)
    bounds = method.intervals(data, LEVELS)
    assert bounds.shape == (len(LEVELS), N_NEW, N_COORDINATES, 2)
    assert bounds.dtype == np.float64
    assert np.isfinite(bounds).all()
    assert (bounds[..., 0] <= bounds[..., 1]).all()


def widens_with_the_level(_name: str, method: Method) -> None:
    """Quantiles that nothing corrects are learnt each by itself: they need not."""
    if method.guarantee == NO_GUARANTEE and method.calibrated_on.needs_quantiles:
        return
    bounds = method.intervals(calibration_data(method.calibrated_on)[0], LEVELS)
    assert (np.diff(bounds[..., 0], axis=0) <= 0).all()
    assert (np.diff(bounds[..., 1], axis=0) >= 0).all()


def repeats_itself_and_changes_nothing(_name: str, method: Method) -> None:
    data, _ = calibration_data(method.calibrated_on)
    with laws.inputs_kept(data), laws.global_random_states_kept():
        one, two = (method.intervals(data, LEVELS) for _ in range(2))
    np.testing.assert_array_equal(one, two)


def is_infinite_where_calibration_rows_are_too_few(_name: str, method: Method) -> None:
    """And only there: 12 rows suffice for 0.8, and not for 0.95."""
    if method.rank is None:
        return
    bounds = method.intervals(calibration_data(method.calibrated_on, n=12)[0], LEVELS)
    suffices = [method.rank(12, level) is not None for level in LEVELS]
    assert suffices in ([True, True, False], [True, False, False])
    for of_level, enough in zip(bounds, suffices, strict=True):
        assert (np.isfinite(of_level) if enough else np.isinf(of_level)).all()


def covers_what_it_promises(_name: str, method: Method) -> None:
    """On exchangeable rows, within four standard errors; where the law of its coverage has a rank, no more than that
    says either, but for the few rows that an interval for everywhere takes to lie in extrapolation.
    """
    if method.guarantee == NO_GUARANTEE:
        return
    shares = []
    for seed in range(N_DRAWS):
        data, truth = calibration_data(method.calibrated_on, seed=seed)
        bounds = method.intervals(data, LEVELS)
        shares.append(((bounds[..., 0] <= truth) & (truth <= bounds[..., 1])).mean(axis=(1, 2)))
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(N_DRAWS)
    for level, mean, error in zip(LEVELS, means, errors, strict=True):
        assert mean >= LEAST[method.guarantee](level) - 4 * error
        if method.rank is not None:
            rank = method.rank(88, level)
            assert rank is not None
            assert mean <= rank / 89 + 4 * error + 0.02 * method.calibrated_on.is_for_extrapolation


def has_one_width_if_it_says_so(_name: str, method: Method) -> None:
    if not method.has_constant_width:
        return
    data, _ = calibration_data(method.calibrated_on)
    predicted = getattr(data, "deployed", data).new
    bounds = method.intervals(data, LEVELS)
    below, above = predicted - bounds[..., 0], bounds[..., 1] - predicted
    np.testing.assert_allclose(below, above, atol=1e-9)
    np.testing.assert_allclose(np.ptp(below, axis=1), 0.0, atol=1e-9)


def has_a_proper_score_if_it_gives_a_distribution(_name: str, method: Method) -> None:
    """Not negative, and for positions a metre off by nearly that much worse."""
    if method.crps is None:
        return
    data, truth = calibration_data(method.calibrated_on)
    with laws.inputs_kept(data, truth), laws.global_random_states_kept():
        near, far = method.crps(data, truth), method.crps(data, truth + 1000.0)
    assert near.shape == truth.shape
    assert (near >= 0).all()
    assert near.mean() < far.mean()
    assert far.mean() == pytest.approx(1000.0, rel=0.05)


def refuses_positions_of_other_rows(_name: str, method: Method) -> None:
    """One true position fewer than predictions."""
    if method.rank is None:
        return
    data, _ = calibration_data(method.calibrated_on)
    data = replace(data, deployed=shortened(data.deployed)) if hasattr(data, "deployed") else shortened(data)
    try:
        method.intervals(data, LEVELS)
    except ValueError:
        return
    raise AssertionError("calibrated on rows that do not belong together")


def shortened(data: Any) -> Any:
    return replace(data, truth=data.truth[1:])


LAWS = (
    is_named,
    has_ordered_bounds_for_each_level_row_and_coordinate,
    widens_with_the_level,
    repeats_itself_and_changes_nothing,
    is_infinite_where_calibration_rows_are_too_few,
    covers_what_it_promises,
    has_one_width_if_it_says_so,
    has_a_proper_score_if_it_gives_a_distribution,
    refuses_positions_of_other_rows,
)


def check_interval_method(name: str, method: Method) -> None:
    for law in LAWS:
        law(name, method)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", INTERVAL_METHODS)
def test_every_interval_method_keeps_the_contract(name: str, law: Callable[[str, Method], None]) -> None:
    law(name, INTERVAL_METHODS[name])


Bounds = Callable[[Array], Array]


def changed(change: Bounds) -> dict[str, Any]:
    """Split conformal prediction whose bounds something changes."""
    split_conformal = INTERVAL_METHODS["scp_crepes"].intervals
    return {"intervals": lambda data, levels: change(split_conformal(data, levels))}


def of_the_widest_level_only(data: PointCalibration, levels: Sequence[float]) -> Array:
    return INTERVAL_METHODS["scp_crepes"].intervals(data, [max(levels)])


def eating_its_data(data: PointCalibration, levels: Sequence[float]) -> Array:
    data.new.sort(axis=0)
    return INTERVAL_METHODS["scp_crepes"].intervals(data, levels)


def of_rows_that_do_not_belong_together(data: PointCalibration, levels: Sequence[float]) -> Array:
    n = min(len(data.truth), len(data.calibration))
    short = replace(data, truth=data.truth[:n], calibration=data.calibration[:n])
    return INTERVAL_METHODS["scp_crepes"].intervals(short, levels)


def seeding(bounds: Array) -> Array:
    np.random.seed(0)
    return bounds


def wider(bounds: Array) -> Array:
    return bounds + np.array([-5.0, 5.0])


def centres(bounds: Array) -> Array:
    return np.repeat(bounds.mean(axis=-1, keepdims=True), 2, axis=-1)


@pytest.mark.parametrize(
    ("law", "fault"),
    [
        (is_named, {"name": "scp"}),
        (is_named, {"guarantee": "always"}),
        (is_named, {"rank": None}),
        (has_ordered_bounds_for_each_level_row_and_coordinate, changed(lambda bounds: bounds[..., ::-1])),
        (has_ordered_bounds_for_each_level_row_and_coordinate, {"intervals": of_the_widest_level_only}),
        (has_ordered_bounds_for_each_level_row_and_coordinate, changed(lambda bounds: bounds * [1.0, np.inf])),
        (widens_with_the_level, changed(lambda bounds: bounds[::-1])),
        (repeats_itself_and_changes_nothing, changed(lambda bounds: bounds + np.random.default_rng().random())),
        (repeats_itself_and_changes_nothing, changed(seeding)),
        (repeats_itself_and_changes_nothing, {"intervals": eating_its_data}),
        (is_infinite_where_calibration_rows_are_too_few, changed(lambda bounds: np.clip(bounds, -1e9, 1e9))),
        (covers_what_it_promises, changed(centres)),
        (covers_what_it_promises, changed(wider)),
        (has_one_width_if_it_says_so, changed(lambda bounds: bounds * [1.0, 1.01])),
        (has_a_proper_score_if_it_gives_a_distribution, {"crps": lambda data, true: data.new - true}),
        (refuses_positions_of_other_rows, {"intervals": of_rows_that_do_not_belong_together}),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, Method], None], fault: dict[str, Any]) -> None:
    method = replace(INTERVAL_METHODS["scp_crepes"], **fault)
    for check in (law, check_interval_method):
        with pytest.raises(AssertionError), np.errstate(invalid="ignore"):
            check("scp_crepes", method)


def test_every_kind_of_calibration_data_has_a_method() -> None:
    assert {method.calibrated_on for method in INTERVAL_METHODS.values()} == set(MAKERS)
