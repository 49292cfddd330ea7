"""Calls of a calibrated model: what it takes, how it answers, and forty wrong ones, each with one sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.sparse import csr_array

from softkin.core.errors import SoftkinError
from softkin.uncertainty.calls import level_of, levels_of
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot

ROWS = bending_arm(4, seed=3)
U = ROWS.commands
X = ROWS.positions
OWN = pd.DataFrame(U, columns=["left", "right"], index=[7, 3, 5, 1])
NAMED = pd.DataFrame(U, columns=["u1", "u2"])
MEASURED = pd.DataFrame(X, columns=["m1_x", "m1_y", "m1_z"])


def with_value(value: Any) -> np.ndarray:
    changed = U.astype(object if not isinstance(value, float) else float).copy()
    changed[2, 1] = value
    return changed


Call = Callable[[Any], object]
WRONG: dict[str, tuple[Call, str]] = {
    "too many columns": (lambda r: r.predict(np.zeros((4, 3))), r"commands of shape \(n_rows, 2\), got \(4, 3\)"),
    "transposed": (lambda r: r.predict(U.T), r"shape \(n_rows, 2\), got \(2, 4\)"),
    "three axes": (lambda r: r.predict(U[None]), r"got \(1, 4, 2\)"),
    "a row too long": (lambda r: r.predict([0.1, 0.2, 0.3]), r"got \(3,\)"),
    "one number": (lambda r: r.predict(0.1), r"got \(\)"),
    "no rows": (lambda r: r.predict(U[:0]), r"got \(0, 2\)"),
    "nothing": (lambda r: r.predict([]), r"got \(0,\)"),
    "None": (lambda r: r.predict(None), r"shape \(n_rows, 2\)"),
    "a word": (lambda r: r.predict("home"), "commands are text"),
    "numbers as text": (lambda r: r.predict([["0.1", "0.2"]]), "commands are text"),
    "a truth value": (lambda r: r.predict(U > 0), "commands are truth values"),
    "complex": (lambda r: r.predict(U + 0j), "commands are complex numbers"),
    "dates": (lambda r: r.predict(np.zeros((1, 2), dtype="datetime64[s]")), "commands are dates"),
    "ragged": (lambda r: r.predict([[0.1, 0.2], [0.3]]), "rows of commands have different lengths"),
    "a mapping": (lambda r: r.predict({"u1": 0.1, "u2": 0.2}), "commands hold dict"),
    "an object": (lambda r: r.predict(with_value("x")), "commands hold str 'x'"),
    "masked": (lambda r: r.predict(np.ma.masked_less(U, 0)), "commands are masked"),
    "NaN": (lambda r: r.predict(with_value(np.nan)), "row 2, column 'u2': nan is no finite number"),
    "missing": (lambda r: r.predict(with_value(None)), "row 2, column 'u2': nan"),
    "infinite": (lambda r: r.is_outside(with_value(np.inf)), "row 2, column 'u2': inf"),
    "too large": (lambda r: r.intervals(with_value(1e200), 0.9), r"row 2, column 'u2': 1e\+200"),
    "NaN in a table": (
        lambda r: r.predict(OWN.drop(index=5).reindex(OWN.index)),
        "row 5, column 'left': nan .* and 1 more",
    ),
    "a column missing": (lambda r: r.predict(OWN[["left"]]), "missing 'right'"),
    "a column unknown": (
        lambda r: r.predict(OWN.rename(columns={"right": "rihgt"})),
        "missing 'right'; unknown 'rihgt'",
    ),
    "a column extra": (lambda r: r.predict(OWN.assign(t=1.0)), "unknown 't'"),
    "a column twice": (lambda r: r.predict(pd.concat([OWN, OWN[["left"]]], axis=1)), "twice 'left'"),
    "names mixed": (lambda r: r.predict(OWN.rename(columns={"left": "u1"})), "missing 'left'; unknown 'u1'"),
    "text in a table": (lambda r: r.predict(OWN.astype({"left": str})), "column 'left' of commands holds no numbers"),
    "truth in a table": (lambda r: r.predict(OWN > 0), "column 'left' of commands holds no numbers"),
    "one column": (lambda r: r.predict(OWN["left"]), "missing 'left', 'right'; unknown '7'"),
    "percent": (lambda r: r.intervals(U, 90), r"90 is no confidence level .*\n  fix: write it as 0.9"),
    "level 0": (lambda r: r.intervals(U, 0), "0 is no confidence level between 0 and 1"),
    "level 1": (lambda r: r.intervals(U, [0.9, 1.0]), "1.0 is no confidence level"),
    "level NaN": (lambda r: r.intervals(U, np.nan), "nan is no confidence level"),
    "level as text": (lambda r: r.intervals(U, "0.9"), "'0.9' is no confidence level"),
    "level True": (lambda r: r.intervals(U, True), "True is no confidence level"),
    "level None": (lambda r: r.intervals(U, None), "None is no confidence level"),
    "no levels": (lambda r: r.intervals(U, []), "no confidence level"),
    "levels in rows": (lambda r: r.intervals(U, [[0.8, 0.9]]), r"\[0.8, 0.9\] is no confidence level"),
    "predicted of others": (lambda r: r.intervals(U, 0.9, X[:2]), r"predicted: expected positions of shape \(4, 3\)"),
    "joint in percent": (lambda r: r.joint_intervals(U, 90), "90 is no confidence level"),
    "joint NaN": (lambda r: r.joint_intervals(with_value(np.nan), 0.9), "row 2, column 'u2': nan"),
    "joint of two columns": (lambda r: r.joint_intervals(OWN[["left"]], 0.9), "missing 'right'"),
    "held by others": (lambda r: r.joint_intervals(U, 0.9).contains(X[:1]), r"positions of shape \(4, 3\)"),
    "held by lost markers": (lambda r: r.joint_intervals(U, 0.9).contains(X * np.nan), "row 0, column 'm1_x': nan"),
    "failure of NaN": (lambda r: r.failure_probability(with_value(np.nan)), "row 2, column 'u2': nan"),
    "box in percent": (lambda r: r.box(95), "fix: write it as 0.95"),
    "loop in percent": (lambda r: r.start(confidence_level=90), "90 is no confidence level"),
    "watch in percent": (lambda r: r.watch(rate=5), "5 is no rate of false alarms"),
    "one pose for all": (lambda r: r.p_values(U, X[:1]), r"positions of shape \(4, 3\), got \(1, 3\)"),
    "positions missing": (lambda r: r.p_values(U, X[:, :2]), r"got \(4, 2\)"),
    "swapped": (lambda r: r.p_values(X, U), r"commands of shape \(n_rows, 2\), got \(4, 3\)"),
    "a marker lost": (lambda r: r.p_values(U, np.where(X[1, 2] == X, np.nan, X)), "row 1, column 'm1_z': nan"),
    "positions' names": (
        lambda r: r.p_values(NAMED, MEASURED[["m1_x", "m1_y"]]),
        "columns of positions: missing 'm1_z'",
    ),
    "other rows": (lambda r: r.p_values(NAMED, MEASURED[::-1]), "have other indices"),
    "rng a seed": (lambda r: r.p_values(U, X, rng=0), "0 is no random generator"),
    "labels of others": (lambda r: r.recalibrate(U[:2] * 0.5, X), r"positions of shape \(2, 3\), got \(4, 3\)"),
    "no rows to suggest": (lambda r: r.suggest(0), "0 is no number of rows"),
    "half a row": (lambda r: r.suggest(2.5), "2.5 is no number of rows"),
    "too many rows": (lambda r: r.suggest(10_001), "10001 is no number of rows"),
    "a seed in words": (lambda r: r.suggest(5, seed="today"), "'today' is no seed"),
    "suggest in percent": (lambda r: r.suggest(5, confidence=90), "90 is no confidence level"),
    "targets of two": (lambda r: r.command_for(X[:, :2]), r"targets of shape \(n_rows, 3\), got \(4, 2\)"),
    "no targets": (lambda r: r.command_for(X[:0]), r"targets of shape \(n_rows, 3\), got \(0, 3\)"),
    "targets as text": (lambda r: r.command_for(["here"]), "targets are text"),
    "a target of NaN": (lambda r: r.command_for(X * np.nan), "row 0, column 'm1_x': nan"),
    "targets' names": (lambda r: r.command_for(MEASURED[["m1_x", "m1_y"]]), "missing 'm1_z'"),
    "no such marker": (lambda r: r.command_for(X, marker=1), "1 is no marker of this robot"),
    "marker by name": (lambda r: r.command_path(X, marker="tip"), "'tip' is no marker of this robot"),
    "target in percent": (lambda r: r.command_for(X, confidence=90), "90 is no confidence level"),
    "no tolerance": (lambda r: r.command_for(X, tolerance=-1), "-1 is no tolerance"),
    "last of NaN": (lambda r: r.command_for(X, last=[0.1, np.nan]), "row 0, column 'u2': nan"),
    "last of two": (lambda r: r.command_for(X, last=U[:2]), "2 commands, where one is sent at a time"),
    "a step from nowhere": (lambda r: r.command_for(X, max_step=0.1), "max_step without a last command"),
    "no step": (lambda r: r.command_path(X, last=U[0], max_step=0), "max_step is 0"),
    "far from all": (lambda r: r.command_for(X, last=[9, 9], max_step=0.1), "no command between the bounds"),
    "another's state": (lambda r: r.command_for(X, last=small_robot("scp_mapie").start()), "a state of another robot"),
    "follow": (lambda r: r.follow(with_value(np.nan)), "row 2, column 'u2': nan"),
    "complex in a table": (lambda r: r.predict(OWN + 0j), "column 'left' of commands holds no numbers"),
    "categories": (lambda r: r.predict(OWN.astype("category")), "column 'left' of commands holds no numbers"),
    "nested columns": (lambda r: r.predict(pd.concat({"a": OWN}, axis=1)), "missing 'left', 'right'"),
    "an unnamed Series": (lambda r: r.predict(pd.Series([0.1, 0.2])), "missing 'left', 'right'"),
    "sparse": (lambda r: r.predict(csr_array(U)), "commands hold csr_array"),
    "a set": (lambda r: r.predict({0.1, 0.2}), "commands hold set"),
    "structured": (lambda r: r.predict(np.zeros(2, dtype=[("left", float)])), "commands are no numbers"),
    "durations": (lambda r: r.predict(np.zeros((1, 2), dtype="timedelta64[s]")), "commands are times"),
    "levels in a set": (lambda r: r.intervals(U, {0.8, 0.9}), "confidence levels in a set"),
    "levels in a mapping": (lambda r: r.joint_intervals(U, {0.9: "mostly"}), "confidence levels in a dict"),
    "nested levels": (lambda r: r.intervals(U, [[0.8, 0.9]]), r"\[0.8, 0.9\] is no confidence level"),
    "a complex level": (lambda r: r.intervals(U, 0.9 + 0j), "is no confidence level"),
    "levels for a box": (lambda r: r.box([0.9]), "is no confidence level"),
    "a session by name": (lambda r: r.start(session="monday"), "no session monday in its recording"),
    "a session of truth": (lambda r: r.follow(U, session=True), "no session True in its recording"),
    "a seed by name": (lambda r: r.watch(seed="a"), "'a' is no seed"),
    "a seed below 0": (lambda r: r.watch(seed=-1), "-1 is no seed"),
    "a target of truth": (lambda r: r.command_for([True, False, True]), "targets are truth values"),
    "a marker of truth": (lambda r: r.command_for(X, marker=True), "True is no marker"),
    "no rows of targets": (lambda r: r.command_path([]), r"targets of shape \(n_rows, 3\), got \(0,\)"),
    "a tolerance of 0": (lambda r: r.command_for(X, tolerance=0), "0 is no tolerance"),
    "steps of another robot": (lambda r: r.command_for(X, last=U[0], max_step=[1, 1, 1]), r"max_step is \[1, 1, 1\]"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_call_gets_one_sentence(name: str) -> None:
    call, says = WRONG[name]
    with pytest.raises(SoftkinError, match=says) as caught:
        call(small_robot())
    assert caught.value.where is not None
    assert caught.value.where.startswith("arm")
    assert caught.value.fix
    assert str(caught.value).count("\n") == 1


def test_there_are_eighty_wrong_calls() -> None:
    assert len(WRONG) >= 80


@pytest.mark.parametrize(
    "commands",
    [
        U.tolist(),
        tuple(map(tuple, U)),
        np.asfortranarray(U),
        U.astype(np.longdouble),
        U[:, ::-1].copy()[:, ::-1],
        U.astype(object),
    ],
)
def test_the_same_numbers_in_any_array_get_the_same_answer(commands: Any) -> None:
    robot: Any = small_robot(shells=True)
    np.testing.assert_array_equal(robot.predict(commands), robot.predict(U))
    np.testing.assert_array_equal(robot.intervals(commands, [0.8]), robot.intervals(U, [0.8]))
    np.testing.assert_array_equal(robot.is_outside(commands), robot.is_outside(U))
    np.testing.assert_array_equal(robot.p_values(commands, X.tolist())[1], robot.p_values(U, X)[1])


@pytest.mark.parametrize(
    "commands", [[1, 0], np.array([[1, 0]]), np.array([1, 0], dtype=np.int8), np.array([1.0, 0.0])]
)
def test_one_row_and_integers_are_welcome(commands: Any) -> None:
    robot: Any = small_robot()
    np.testing.assert_array_equal(robot.predict(commands), robot.predict(np.array([[1.0, 0.0]])))


@pytest.mark.parametrize("order", [["left", "right"], ["right", "left"]])
def test_a_table_is_read_by_its_names_and_answered_by_one(order: list[str]) -> None:
    robot: Any = small_robot(shells=True)
    table = OWN[order]
    for frame in (table, table.rename(columns={"left": "u1", "right": "u2"})):
        predicted = robot.predict(frame)
        assert list(predicted.columns) == ["m1_x", "m1_y", "m1_z"]
        assert predicted.index.equals(OWN.index)
        np.testing.assert_array_equal(predicted, robot.predict(U))
        pd.testing.assert_series_equal(
            robot.is_outside(frame), pd.Series(robot.is_outside(U), index=OWN.index, name="outside")
        )
        single, joint = robot.p_values(frame, MEASURED.set_axis(OWN.index))
        np.testing.assert_array_equal(single, robot.p_values(U, X)[0])
        assert joint.index.equals(OWN.index)
    whole = robot.predict(pd.DataFrame({"right": [0, 1], "left": [1, 0]}))
    np.testing.assert_array_equal(whole, robot.predict([[1, 0], [0, 1]]))
    row = table.loc[3]
    np.testing.assert_array_equal(robot.predict(row), robot.predict(U[1]))
    assert list(robot.predict(row).index) == [3]


def test_intervals_of_a_table() -> None:
    robot: Any = small_robot()
    one, many = robot.intervals(OWN, 0.9), robot.intervals(OWN, [0.9, 0.8])
    assert list(one.columns)[:3] == ["lower_m1_x", "upper_m1_x", "lower_m1_y"]
    np.testing.assert_array_equal(one.to_numpy().reshape(4, 3, 2), robot.intervals(U, [0.9])[0])
    pd.testing.assert_frame_equal(many[0.9], one)
    assert (many[0.8]["upper_m1_x"] <= many[0.9]["upper_m1_x"]).all()


def test_positions_by_their_own_names_are_in_their_own_unit() -> None:
    robot: Any = small_robot()
    own = pd.DataFrame(X / 10, columns=["tip x", "tip y", "tip z"])[["tip z", "tip x", "tip y"]]
    for one, other in zip(robot.p_values(NAMED, own), robot.p_values(NAMED, MEASURED), strict=True):
        np.testing.assert_allclose(one, other)


def test_levels_come_back_in_the_order_that_was_asked_for() -> None:
    robot: Any = small_robot("scp_mapie", shells=True)
    many = robot.intervals(U, [0.9, 0.5, 0.9, 0.8])
    for place, level in enumerate((0.9, 0.5, 0.9, 0.8)):
        np.testing.assert_array_equal(many[place], robot.intervals(U, level))
    assert robot.intervals(U, np.array(0.9)).shape == (4, 3, 2)


def test_a_level_is_the_decimals_that_it_is_written_with() -> None:
    assert level_of(np.float32(0.9), "arm") == 0.9
    assert levels_of(np.array([0.8, 0.9], dtype=np.float32), "arm") == ([0.8, 0.9], False)
    assert levels_of(0.95, "arm") == ([0.95], True)
