"""What every target space of the registry must do."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.preprocessing import StandardScaler

from softkin.core.samples import Array, Samples
from softkin.models.estimators.position_scaler import PositionScaler
from softkin.models.target_spaces import TARGET_SPACES
from softkin.models.target_spaces.spec import TargetSpace
from tests.conftest import bending_arm
from tests.contract import laws

BASES = (None, {"origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]})
#: How near (mm) a position comes back to itself.
CLOSE = 1e-8


def arm(n: int, seed: int) -> Samples:
    """Two commands, three markers, the first of which never moves."""
    return bending_arm(n, n_markers=3, seed=seed)


def fitted(space: TargetSpace, skip_constant: bool = True, base: Any = None, seed: int = 0) -> Any:
    rows = arm(80, seed)
    return space.transformer(skip_constant, base).fit(rows.positions, rows.commands)


def is_named(name: str, space: TargetSpace) -> None:
    laws.has_name_and_title(name, space)


def has_standardised_targets(_name: str, space: TargetSpace) -> None:
    for skip_constant in (True, False):
        targets = fitted(space, skip_constant).transform(arm(80, 0).positions)
        assert targets.ndim == 2
        assert len(targets) == 80
        varies = np.ptp(targets, axis=0) > 0
        assert varies.all() or not skip_constant
        np.testing.assert_allclose(targets.mean(axis=0), 0.0, atol=1e-9)
        np.testing.assert_allclose(targets[:, varies].std(axis=0), 1.0, atol=1e-9)


def brings_every_position_back(_name: str, space: TargetSpace) -> None:
    """Those it is fitted on and those of other rows; with and without the base declared."""
    for skip_constant in (True, False):
        for base in BASES:
            transformer = fitted(space, skip_constant, base)
            for positions in (arm(80, 0).positions, arm(30, 1).positions):
                again = transformer.inverse_transform(transformer.transform(positions))
                assert again.shape == positions.shape
                np.testing.assert_allclose(again, positions, atol=CLOSE)


def brings_small_spreads_back_to_first_order(_name: str, space: TargetSpace) -> None:
    """As large as the standard deviation of positions whose targets are drawn with that spread."""
    transformer, rng = fitted(space), np.random.default_rng(0)
    for target in transformer.transform(arm(5, 1).positions):
        targets = np.tile(target, (4000, 1))
        spread = np.broadcast_to(1e-3 * rng.uniform(0.5, 2.0, len(target)), targets.shape)
        expected = transformer.inverse_transform(targets + spread * rng.standard_normal(targets.shape)).std(axis=0)
        spread_mm = transformer.inverse_spread(targets[:1], spread[:1])
        assert spread_mm.shape == (1, 9)
        np.testing.assert_allclose(spread_mm[0], expected, rtol=0.1, atol=1e-9)


def repeats_itself_and_changes_nothing(_name: str, space: TargetSpace) -> None:
    rows, results = arm(80, 0), []
    transformer = space.transformer(True, None)
    with laws.inputs_kept(rows), laws.global_random_states_kept():
        for one in (clone(transformer), clone(transformer)):
            targets = one.fit(rows.positions, rows.commands).transform(rows.positions)
            with laws.inputs_kept(targets):
                results += [targets, one.inverse_transform(targets), one.inverse_spread(targets, abs(targets))]
    for first, second in zip(results[:3], results[3:], strict=True):
        np.testing.assert_array_equal(first, second)


def is_the_same_when_stored(_name: str, space: TargetSpace) -> None:
    transformer, positions = fitted(space), arm(30, 1).positions
    stored = pickle.loads(pickle.dumps(transformer))
    np.testing.assert_array_equal(stored.transform(positions), transformer.transform(positions))


def refuses_positions_of_another_robot(_name: str, space: TargetSpace) -> None:
    transformer = fitted(space)
    try:
        transformer.transform(bending_arm(10).positions)
    except (ValueError, IndexError):
        return
    raise AssertionError("transformed one marker in place of three")


LAWS = (
    is_named,
    has_standardised_targets,
    brings_every_position_back,
    brings_small_spreads_back_to_first_order,
    repeats_itself_and_changes_nothing,
    is_the_same_when_stored,
    refuses_positions_of_another_robot,
)


def check_target_space(name: str, space: TargetSpace) -> None:
    for law in LAWS:
        law(name, space)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", TARGET_SPACES)
def test_every_target_space_keeps_the_contract(name: str, law: Callable[[str, TargetSpace], None]) -> None:
    law(name, TARGET_SPACES[name])


class Unscaled(PositionScaler):
    def transform(self, X: Array) -> Array:
        return X[:, self.kept_]

    def inverse_transform(self, X: Array) -> Array:
        return super().inverse_transform(super().transform(self._whole(X)))

    def _whole(self, X: Array) -> Array:
        positions = np.tile(self.constants_, (len(X), 1))
        positions[:, self.kept_] = X
        return positions


class Shifted(PositionScaler):
    def inverse_transform(self, X: Array) -> Array:
        return super().inverse_transform(X) + 1e-3


class Doubled(PositionScaler):
    def inverse_spread(self, X: Array, spread: Array) -> Array:
        return 2 * super().inverse_spread(X, spread)


class Eating(PositionScaler):
    def transform(self, X: Array) -> Array:
        targets = super().transform(X)
        X[:, -1] = 0.0
        return targets


class Cutting(PositionScaler):
    def transform(self, X: Array) -> Array:
        return super().transform(np.pad(X, ((0, 0), (0, 9 - X.shape[1]))))


class Forgetful(PositionScaler):
    def __getstate__(self) -> dict[str, Any]:
        state: dict[str, Any] = super().__getstate__()
        return state | {"scaler_": StandardScaler(with_mean=False).fit(np.ones((2, 6)))}


@pytest.mark.parametrize(
    ("law", "transformer"),
    [
        (has_standardised_targets, Unscaled),
        (brings_every_position_back, Shifted),
        (brings_small_spreads_back_to_first_order, Doubled),
        (repeats_itself_and_changes_nothing, Eating),
        (is_the_same_when_stored, Forgetful),
        (refuses_positions_of_another_robot, Cutting),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, TargetSpace], None], transformer: type[PositionScaler]) -> None:
    space = replace(TARGET_SPACES["cartesian"], transformer=lambda skip_constant, _: transformer(skip_constant))
    for check in (law, check_target_space):
        with pytest.raises(AssertionError):
            check("cartesian", space)


def test_another_name_breaks_the_contract() -> None:
    with pytest.raises(AssertionError):
        check_target_space("polar", TARGET_SPACES["cartesian"])
