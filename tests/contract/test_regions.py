"""What every joint region of the registry must do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.regions.spec import Region, RegionMethod
from tests.contract import laws

#: Two markers of three coordinates each, of three that the robot has.
MARKERS = np.array([0, 0, 0, 2, 2, 2])
N, N_NEW, N_TRAIN, LEVEL = 88, 89, 200, 0.9
N_DRAWS = 60


def residuals(n: int, seed: int) -> Array:
    """Errors in mm, the second marker's ten times as large, the coordinates of each correlated."""
    mixed = np.random.default_rng(seed).standard_normal((n, 6))
    return np.asarray(mixed @ (np.eye(6) + 0.5 * np.kron(np.eye(2), np.ones((3, 3)))) * np.repeat([1.0, 10.0], 3))


def parts(seed: int = 0, factor: float = 1.0) -> tuple[Array, Array, Array]:
    """Of train, of the calibration set, and new ones."""
    train, calibration, new = np.split(factor * residuals(N_TRAIN + N + N_NEW, seed), [N_TRAIN, N_TRAIN + N])
    return train, calibration, new


def made(method: RegionMethod, level: float = LEVEL, factor: float = 1.0) -> Region:
    train, calibration, _ = parts(factor=factor)
    return method.region(train, calibration, MARKERS, level)


def is_named(name: str, method: RegionMethod) -> None:
    laws.has_name_and_title(name, method)


def covers_rows_and_has_a_size(_name: str, method: RegionMethod) -> None:
    region, (*_, new) = made(method), parts()
    covered = region.covers(new)
    assert covered.shape == (N_NEW,)
    assert covered.dtype == np.bool_
    assert isinstance(region.size_mm, float)
    assert 0 < region.size_mm < np.inf
    assert region.covers(np.zeros((1, 6))).all()
    assert not region.covers(np.full((1, 6), 1e6)).any()


def covers_what_it_promises(_name: str, method: RegionMethod) -> None:
    """Over exchangeable rows: rank / (n + 1) within four standard errors where it is exact, at least that elsewhere."""
    shares = []
    for seed in range(N_DRAWS):
        train, calibration, new = parts(seed)
        shares.append(method.region(train, calibration, MARKERS, LEVEL).covers(new).mean())
    mean, error, rank = np.mean(shares), np.std(shares) / np.sqrt(N_DRAWS), conformal_rank(N, LEVEL)
    assert rank is not None
    assert mean >= rank / (N + 1) - 4 * error
    assert mean <= rank / (N + 1) + 4 * error or not method.is_exact


def grows_with_the_level(_name: str, method: RegionMethod) -> None:
    (narrow, wide), (*_, new) = (made(method, level) for level in (0.8, 0.95)), parts()
    assert narrow.size_mm < wide.size_mm
    assert not (narrow.covers(new) & ~wide.covers(new)).any()


def is_everything_where_calibration_rows_are_too_few(_name: str, method: RegionMethod) -> None:
    train, calibration, new = parts()
    region = method.region(train, calibration[:5], MARKERS, 0.95)
    assert region.size_mm == np.inf
    assert region.covers(1e9 * new).all()


def scales_with_the_unit(_name: str, method: RegionMethod) -> None:
    (one, ten), (*_, new) = (made(method, factor=factor) for factor in (1.0, 10.0)), parts()
    assert ten.size_mm == pytest.approx(10 * one.size_mm)
    np.testing.assert_array_equal(one.covers(new), ten.covers(10 * new))


def repeats_itself_and_changes_nothing(_name: str, method: RegionMethod) -> None:
    train, calibration, new = parts()
    with laws.inputs_kept(train, calibration, new, MARKERS), laws.global_random_states_kept():
        one, two = (method.region(train, calibration, MARKERS, LEVEL) for _ in range(2))
        covered = [region.covers(new) for region in (one, two, one)]
    assert one.size_mm == two.size_mm
    np.testing.assert_array_equal(covered[0], covered[1])
    np.testing.assert_array_equal(covered[0], covered[2])


def divides_by_no_error_of_train(_name: str, method: RegionMethod) -> None:
    """A model that repeats `train` exactly has no errors there."""
    train, calibration, _ = parts()
    region = method.region(np.zeros_like(train), calibration, MARKERS, LEVEL)
    assert 0 < region.size_mm < np.inf
    assert region.covers(np.zeros((1, 6))).all()


LAWS = (
    is_named,
    covers_rows_and_has_a_size,
    covers_what_it_promises,
    grows_with_the_level,
    is_everything_where_calibration_rows_are_too_few,
    scales_with_the_unit,
    repeats_itself_and_changes_nothing,
    divides_by_no_error_of_train,
)


def check_region(name: str, method: RegionMethod) -> None:
    for law in LAWS:
        law(name, method)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", REGION_METHODS)
def test_every_region_keeps_the_contract(name: str, law: Callable[[str, RegionMethod], None]) -> None:
    law(name, REGION_METHODS[name])


Covered = NDArray[np.bool_]


def changed(
    covers: Callable[[Region, Array], Covered] = lambda region, new: region.covers(new),
    size_mm: Callable[[float], float] = float,
) -> dict[str, Any]:
    """A box of which something is changed."""

    def region(*of: Any) -> Region:
        box = REGION_METHODS["joint_box"].region(*of)
        return Region(lambda new: covers(box, new), size_mm(box.size_mm))

    return {"region": region}


def divided_by_errors_of_train(train: Array, *rest: Any) -> Region:
    box = REGION_METHODS["joint_box"].region(train, *rest)
    with np.errstate(divide="ignore"):
        return Region(box.covers, float(box.size_mm / np.abs(train).mean()))


def of_constant_size(train: Array, calibration: Array, markers: NDArray[np.intp], level: float) -> Region:
    return REGION_METHODS["joint_box"].region(train, calibration, markers, min(level, 0.8))


@pytest.mark.parametrize(
    ("law", "fault"),
    [
        (is_named, {"title": " "}),
        (covers_rows_and_has_a_size, changed(lambda _, new: np.zeros(len(new), dtype=bool))),
        (covers_rows_and_has_a_size, changed(lambda region, new: region.covers(new)[:, None])),
        (covers_rows_and_has_a_size, changed(size_mm=lambda size: -size)),
        (covers_what_it_promises, changed(lambda region, new: region.covers(1.2 * new))),
        (covers_what_it_promises, changed(lambda region, new: region.covers(0.5 * new))),
        (grows_with_the_level, {"region": of_constant_size}),
        (is_everything_where_calibration_rows_are_too_few, changed(size_mm=lambda size: min(size, 1e9))),
        (scales_with_the_unit, changed(size_mm=lambda size: size**3)),
        (repeats_itself_and_changes_nothing, changed(size_mm=lambda size: size + np.random.default_rng().random())),
        (divides_by_no_error_of_train, {"region": divided_by_errors_of_train}),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, RegionMethod], None], fault: dict[str, Any]) -> None:
    method = replace(REGION_METHODS["joint_box"], **fault)
    for check in (law, check_region):
        with pytest.raises(AssertionError):
            check("joint_box", method)
