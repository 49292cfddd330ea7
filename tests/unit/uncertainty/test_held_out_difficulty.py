"""How hard commands are, by errors on held-out rows."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty import held_out_difficulty as module
from softkin.uncertainty.held_out_difficulty import LEAST, NEIGHBOURS, HeldOutDifficulty, fit_difficulty

COMMANDS = np.random.default_rng(0).uniform(-1, 1, (400, 2))
NOISE = np.abs(np.random.default_rng(1).standard_normal((400, 1)))


def fitted(size: Array) -> HeldOutDifficulty:
    """Of errors of this typical size (n_rows,)."""
    return fit_difficulty(COMMANDS, NOISE * size[:, None], np.array([0]))


def test_errors_of_one_size_make_no_command_hard() -> None:
    """Ten draws: noise is taken for a difference in one at most, and then for a small one."""
    rng = np.random.default_rng(2)
    found = [fit_difficulty(COMMANDS[:200], np.abs(rng.standard_normal((200, 1))), np.array([0])) for _ in range(10)]
    assert sum(bool(one.shares[0]) for one in found) <= 1
    assert max(np.ptp(np.log(one.of(COMMANDS))) for one in found) < np.log(2.5)


@pytest.mark.parametrize("by_norm", [False, True])
def test_it_grows_as_errors_do(by_norm: bool) -> None:
    """Tenfold along a command, or with the norm: known to a third in most places."""
    along = np.linalg.norm(COMMANDS - COMMANDS.mean(axis=0), axis=1) if by_norm else COMMANDS[:, 0]
    difficulty = fitted(10**along)
    assert difficulty.by_norm[0] == by_norm
    ratio = np.log(difficulty.of(COMMANDS)[:, 0] / 10**along)
    assert np.quantile(np.abs(ratio - np.median(ratio)), 0.8) < np.log(4 / 3)


def test_units_and_gross_errors_do_not_count() -> None:
    size = 10 ** COMMANDS[:, 0]
    plain, gross = fitted(size), size.copy()
    gross[:3] *= 1e6
    np.testing.assert_allclose(fitted(1e-9 * size).of(COMMANDS), plain.of(COMMANDS))
    change = np.abs(np.log(fitted(gross).of(COMMANDS) / plain.of(COMMANDS)))
    assert np.quantile(change, 0.8) < np.log(1.5)


def test_columns_of_errors_are_those_of_their_coordinates() -> None:
    errors = np.column_stack([NOISE[:, 0] * 10 ** COMMANDS[:, 0], np.zeros(400)])
    found = fit_difficulty(COMMANDS, errors, np.array([0, 1, 0, -1])).of(COMMANDS[:50])
    np.testing.assert_array_equal(found[:, 0], found[:, 2])
    np.testing.assert_array_equal(found[:, [1, 3]], 1.0)
    assert np.ptp(found[:, 0]) > 1


def test_no_command_is_easier_than_the_least_and_few_rows_do_not_matter() -> None:
    assert fitted(1e6 ** COMMANDS[:, 0]).of(COMMANDS).min() == LEAST
    few = fit_difficulty(COMMANDS[: NEIGHBOURS[0]], NOISE[: NEIGHBOURS[0]], np.array([0]))
    np.testing.assert_array_equal(few.of(COMMANDS), 1.0)
    same = fit_difficulty(np.ones((30, 2)), NOISE[:30], np.array([0]))
    assert np.isfinite(same.of(COMMANDS)).all()


def test_of_many_rows_some_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_ROWS", 50)
    difficulty = fitted(10 ** COMMANDS[:, 0])
    assert len(difficulty.points) == len(difficulty.errors) == 50
