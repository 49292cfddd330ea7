"""What every check of the audit must do."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION, Samples
from softkin.data.audit import CHECKS
from softkin.data.audit.findings import LEAK, MAX_ROWS_LISTED, NOTE, SEVERITIES, CheckResult, Finding
from tests.contract import laws
from tests.recorded_robot import recorded_arm
from tests.unit.data.audit.clean_robot import clean_robot

Robot = dict[str, Samples]
Check = Callable[[Mapping[str, Samples]], CheckResult]


def clean() -> Robot:
    """Two commands, two markers; 168 rows of train, 21 of validation and of test, 90 of extrapolation."""
    return clean_robot(300, n_commands=2, n_markers=2, seed=3)


def with_copies() -> Robot:
    """Rows of train repeat others; rows of validation and extrapolation stand in train, those of test nearly."""
    robot = clean()
    train = robot[TRAIN]
    train.commands[1::2], train.positions[1::2] = train.commands[::2], train.positions[::2]
    for subset, factor in ((VALIDATION, 1.0), (TEST, 1 + 1e-9), (EXTRAPOLATION, 1.0)):
        n_copies = len(robot[subset]) // 2
        robot[subset].commands[:n_copies] = factor * train.commands[:n_copies]
    return robot


def of_few_commands() -> Robot:
    robot = clean()
    for rows in robot.values():
        rows.commands[:] = rows.commands[np.arange(len(rows)) % 9]
    return robot


def that_hardly_moves() -> Robot:
    robot = clean()
    for rows in robot.values():
        rows.commands[:, 1] = 0.5
        rows.positions[:, 0] = 3.0
    return robot


def with_failed_poses() -> Robot:
    """A pose that is stuck, one that is lost, one that is far off."""
    robot = clean()
    for rows in robot.values():
        rows.positions[3:12] = rows.positions[3]
        rows.positions[14:16] = 0.0
        rows.positions[18] += 900.0
    return robot


def of_shifted_subsets() -> Robot:
    robot = clean()
    order = np.argsort(robot[TRAIN].commands[:, 0])
    robot[TEST] = Samples(robot[TRAIN].commands[order[-60:]], robot[TRAIN].positions[order[-60:]])
    robot[EXTRAPOLATION] = Samples(robot[TRAIN].commands + 1e-3, robot[TRAIN].positions)
    return robot


def of_few_calibration_rows() -> Robot:
    robot = clean()
    return robot | {VALIDATION: Samples(robot[VALIDATION].commands[:5], robot[VALIDATION].positions[:5])}


def of_one_calibration_block() -> Robot:
    robot = clean()
    return robot | {VALIDATION: replace(robot[VALIDATION], block=np.zeros(len(robot[VALIDATION]), dtype=np.int64))}


def that_is_read_wrongly() -> Robot:
    """A command is twice another; the markers of some rows are swapped; every command has two poses."""
    robot = {}
    for name, rows in clean_robot(300, n_commands=2, n_markers=4, seed=3).items():
        points = rows.positions.reshape(len(rows), 4, 3).copy()
        points[::5] = points[::5, [1, 0, 2, 3]]
        commands = np.column_stack([rows.commands, 2 * rows.commands[:, :1]])
        commands, positions = np.vstack([commands, commands]), points.reshape(len(rows), 12)
        robot[name] = Samples(commands, np.vstack([positions, positions + 20.0]))
    return robot


def that_remembers() -> Robot:
    rows = recorded_arm(300, backlash=0.05)
    return {subset: rows.take(np.arange(place, 300, 4)) for place, subset in enumerate(SUBSETS)}


FAULTS = (
    with_copies,
    of_few_commands,
    of_few_calibration_rows,
    that_hardly_moves,
    with_failed_poses,
    of_shifted_subsets,
    of_one_calibration_block,
    that_is_read_wrongly,
    that_remembers,
)


@cache
def robots() -> tuple[Robot, ...]:
    return (clean(), *(fault() for fault in FAULTS))


@cache
def results(check: Check) -> tuple[CheckResult, ...]:
    """Of each of `robots`."""
    return tuple(map(check, robots()))


def is_named(name: str, check: Check) -> None:
    """As its module."""
    assert check.__module__.rpartition(".")[2] == name


def is_quiet_about_a_clean_robot(_name: str, check: Check) -> None:
    assert [finding for finding in results(check)[0].findings if finding.severity != NOTE] == []


def finds_something_in_a_faulty_robot(_name: str, check: Check) -> None:
    assert any(result.findings for result in results(check)[1:])


def says_what_it_finds(_name: str, check: Check) -> None:
    for result in results(check):
        for finding in result.findings:
            assert finding.code.strip()
            assert finding.severity in SEVERITIES
            assert finding.sentence.endswith((".", "?"))
            assert finding.consequence.endswith((".", "?"))
            assert finding.subsets
            assert set(finding.subsets) <= set(SUBSETS)


def names_rows_that_there_are(_name: str, check: Check) -> None:
    """Ascending numbers within each subset, the first of them at most; all are counted."""
    for robot, result in zip(robots(), results(check), strict=True):
        for finding in result.findings:
            assert set(finding.rows) == set(finding.n_rows)
            assert set(finding.rows) <= set(finding.subsets)
            for subset, rows in finding.rows.items():
                assert len(rows) == min(finding.n_rows[subset], MAX_ROWS_LISTED)
                assert list(rows) == sorted(set(rows))
                assert 0 <= rows[0] <= rows[-1] < len(robot[subset])


def gives_plain_numbers(_name: str, check: Check) -> None:
    """For JSON, found something or not."""
    for result in results(check):
        for value in (result.numbers, *(finding.as_dict() for finding in result.findings)):
            assert json_of(value) is not None
        assert result.numbers


def json_of(value: object) -> object:
    """What a file holds of `value`, or None where it cannot."""
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError):
        return None


def repeats_itself_and_changes_nothing(_name: str, check: Check) -> None:
    for robot, result in zip((clean(), with_failed_poses()), (check(clean()), check(with_failed_poses())), strict=True):
        with laws.inputs_kept(robot), laws.global_random_states_kept():
            assert check(robot) == result


LAWS = (
    is_named,
    is_quiet_about_a_clean_robot,
    finds_something_in_a_faulty_robot,
    says_what_it_finds,
    names_rows_that_there_are,
    gives_plain_numbers,
    repeats_itself_and_changes_nothing,
)


def check_check(name: str, check: Check) -> None:
    for law in LAWS:
        law(name, check)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", CHECKS)
def test_every_check_keeps_the_contract(name: str, law: Callable[[str, Check], None]) -> None:
    law(name, CHECKS[name])


Change = Callable[[CheckResult], CheckResult]


def changed(change: Change) -> Check:
    """The check of constant columns, of whose results something is changed."""

    def check(robot: Mapping[str, Samples]) -> CheckResult:
        return change(CHECKS["duplicate_rows"](robot))

    check.__module__ = CHECKS["duplicate_rows"].__module__
    return check


def findings(**fault: object) -> Change:
    return lambda result: CheckResult(
        tuple(replace(finding, **fault) for finding in result.findings),  # type: ignore[arg-type]
        result.numbers,
    )


ALARM = Finding("alarm", LEAK, (TRAIN,), "Something is wrong.", "Look at it.")


@pytest.mark.parametrize(
    ("law", "change"),
    [
        (is_quiet_about_a_clean_robot, lambda result: CheckResult((ALARM,), result.numbers)),
        (finds_something_in_a_faulty_robot, lambda result: CheckResult((), result.numbers)),
        (says_what_it_finds, findings(severity="grave")),
        (says_what_it_finds, findings(subsets=("training",))),
        (says_what_it_finds, findings(consequence="")),
        (names_rows_that_there_are, findings(rows={TRAIN: (1, 10_000)}, n_rows={TRAIN: 2})),
        (names_rows_that_there_are, findings(rows={TRAIN: (1, 2)}, n_rows={TRAIN: 3})),
        (gives_plain_numbers, lambda result: CheckResult(result.findings, {"rows": np.arange(3)})),
        (gives_plain_numbers, lambda result: CheckResult(result.findings, {"share": float("nan")})),
        (gives_plain_numbers, lambda result: CheckResult(result.findings, {})),
        (
            repeats_itself_and_changes_nothing,
            lambda result: CheckResult(result.findings, {"share": np.random.default_rng().random()}),
        ),
        (
            repeats_itself_and_changes_nothing,
            lambda result: CheckResult(result.findings, {"share": np.random.random()}),
        ),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, Check], None], change: Change) -> None:
    check = changed(change)
    for contract in (law, check_check):
        with pytest.raises(AssertionError):
            contract("duplicate_rows", check)


def test_a_check_that_eats_its_data_breaks_the_contract() -> None:
    def check(robot: Mapping[str, Samples]) -> CheckResult:
        for rows in robot.values():
            rows.positions.sort(axis=0)
        return CheckResult((), {"rows": 0})

    with pytest.raises(AssertionError, match="an input was modified"):
        repeats_itself_and_changes_nothing("sorted", check)


def test_another_name_breaks_the_contract() -> None:
    with pytest.raises(AssertionError):
        check_check("copies", CHECKS["duplicate_rows"])
