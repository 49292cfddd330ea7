"""What every labelled method of the registry must do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty.intervals.spec import GUARANTEES, MARGINAL
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.labelled.spec import LONG_RUN, NO_LABELS, ONE_BY_ONE, Answer, Labelled, LabelledMethod
from tests.contract import laws

LEVELS = (0.8, 0.9, 0.95)
N_NEW = 200
N_DRAWS = 20
#: The method that the laws are broken with: it has a guarantee.
EXACT = "oracle_constant"


def norm(commands: Array) -> Array:
    return np.asarray(np.linalg.norm(commands, axis=1))


def labelled(n: int = 140, n_new: int = N_NEW, seed: int = 0) -> Labelled:
    """Commands of a disc, new ones drawn as all others; errors (n_rows, 3) in mm that grow with the norm."""
    rng = np.random.default_rng(seed)

    def rows(n_rows: int) -> tuple[Array, Array]:
        angle, radius = rng.uniform(0, 2 * np.pi, n_rows), rng.uniform(0, 1, n_rows)
        commands = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        return commands, rng.standard_normal((n_rows, 3)) * (0.5 + radius)[:, None]

    (train, _), calibration, new = rows(400), rows(n), rows(n_new)
    return Labelled(train, *calibration, *new, norm)


def is_named(name: str, method: LabelledMethod) -> None:
    laws.has_name_and_title(name, method)
    assert method.labels.strip()
    assert method.guarantee in (*GUARANTEES, LONG_RUN)


def has_a_half_width_for_each_level_row_and_coordinate(_name: str, method: LabelledMethod) -> None:
    answer = method.answer(labelled(), LEVELS, 0)
    assert answer.half_widths.shape == (len(LEVELS), len(answer.scored), 3)
    assert not np.isnan(answer.half_widths).any()
    assert (answer.half_widths >= 0).all()
    assert len(answer.scored) > N_NEW / 2
    assert (np.diff(answer.scored) > 0).all()
    assert set(answer.scored.tolist()) <= set(range(N_NEW))
    assert list(answer.refused) == [""] * len(LEVELS)
    assert all(np.isfinite(number) for number in answer.details.values())


def widens_with_the_level(_name: str, method: LabelledMethod) -> None:
    """Where rows are taken one by one each level goes its own way."""
    if method.labels != ONE_BY_ONE:
        assert (np.diff(method.answer(labelled(), LEVELS, 0).half_widths, axis=0) >= 0).all()


def repeats_itself_under_a_seed(_name: str, method: LabelledMethod) -> None:
    rows = labelled()
    with laws.inputs_kept(rows), laws.global_random_states_kept():
        one, two = (method.answer(rows, LEVELS, 0) for _ in range(2))
    np.testing.assert_array_equal(one.half_widths, two.half_widths)
    np.testing.assert_array_equal(one.scored, two.scored)
    assert dict(one.details) == dict(two.details)


def refuses_or_is_infinite_where_rows_are_too_few(_name: str, method: LabelledMethod) -> None:
    """Ten rows to be calibrated on, and ten to be scored, do not suffice for 0.95."""
    answer = method.answer(labelled(n=10, n_new=10), [0.95], 0)
    assert answer.refused[0] or np.isinf(answer.half_widths[:, 0]).any()


def looks_at_no_labels_but_those_it_says(_name: str, method: LabelledMethod) -> None:
    """No row's own error widens its interval; without labels no error of a new row does."""
    rows = labelled()
    answer = method.answer(rows, LEVELS, 0)
    place = len(answer.scored) // 2
    errors = rows.errors.copy()
    errors[answer.scored[place]] *= 100.0
    again = method.answer(replace(rows, errors=errors), LEVELS, 0)
    np.testing.assert_array_equal(again.half_widths[:, place], answer.half_widths[:, place])
    if method.labels == NO_LABELS:
        again = method.answer(replace(rows, errors=100.0 * rows.errors), LEVELS, 0)
        np.testing.assert_array_equal(again.half_widths, answer.half_widths)


def covers_what_it_promises(_name: str, method: LabelledMethod) -> None:
    """New rows are like the calibration rows here; within four standard errors."""
    if method.guarantee not in (MARGINAL, LONG_RUN):
        return
    shares = np.array([coverage(method, seed) for seed in range(N_DRAWS)])
    means, errors = shares.mean(axis=0), shares.std(axis=0) / np.sqrt(N_DRAWS)
    least = np.array(LEVELS) - (0.01 if method.guarantee == LONG_RUN else 1e-9)
    assert (means >= least - 4 * errors).all()


def coverage(method: LabelledMethod, seed: int) -> Array:
    rows = drawn(seed)
    answer = method.answer(rows, LEVELS, seed)
    return np.asarray((np.abs(rows.errors[answer.scored]) <= answer.half_widths).mean(axis=(1, 2)))


drawn = cache(lambda seed: labelled(seed=seed))

LAWS = (
    is_named,
    has_a_half_width_for_each_level_row_and_coordinate,
    widens_with_the_level,
    repeats_itself_under_a_seed,
    refuses_or_is_infinite_where_rows_are_too_few,
    looks_at_no_labels_but_those_it_says,
    covers_what_it_promises,
)


def check_labelled_method(name: str, method: LabelledMethod) -> None:
    for law in LAWS:
        law(name, method)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", LABELLED_METHODS)
def test_every_labelled_method_keeps_the_contract(name: str, law: Callable[[str, LabelledMethod], None]) -> None:
    law(name, LABELLED_METHODS[name])


def changed(change: Callable[[Labelled, Array], Array]) -> dict[str, Any]:
    """The method whose half-widths something changes."""

    def answer(rows: Labelled, levels: Sequence[float], seed: int) -> Answer:
        plain = LABELLED_METHODS[EXACT].answer(rows, levels, seed)
        return replace(plain, half_widths=change(rows, plain.half_widths))

    return {"answer": answer}


def of_rows_that_there_are_not(rows: Labelled, levels: Sequence[float], seed: int) -> Answer:
    plain = LABELLED_METHODS[EXACT].answer(rows, levels, seed)
    return replace(plain, scored=plain.scored + 1)


def calibrated_on_itself(rows: Labelled, half_widths: Array) -> Array:
    limits = np.quantile(np.abs(rows.errors), LEVELS[: len(half_widths)], axis=0)
    return np.maximum(half_widths, np.maximum(limits[:, None], np.abs(rows.errors)))


@pytest.mark.parametrize(
    ("law", "fault"),
    [
        (is_named, {"name": "prophet"}),
        (is_named, {"guarantee": "always"}),
        (has_a_half_width_for_each_level_row_and_coordinate, changed(lambda _, halves: halves[0])),
        (has_a_half_width_for_each_level_row_and_coordinate, changed(lambda _, halves: -halves)),
        (has_a_half_width_for_each_level_row_and_coordinate, {"answer": of_rows_that_there_are_not}),
        (widens_with_the_level, changed(lambda _, halves: halves[::-1])),
        (repeats_itself_under_a_seed, changed(lambda _, halves: halves + np.random.default_rng().random())),
        (repeats_itself_under_a_seed, changed(lambda _, halves: halves + np.random.random())),
        (refuses_or_is_infinite_where_rows_are_too_few, changed(lambda _, halves: np.minimum(halves, 1e9))),
        (looks_at_no_labels_but_those_it_says, changed(calibrated_on_itself)),
        (looks_at_no_labels_but_those_it_says, {"labels": NO_LABELS}),
        (covers_what_it_promises, changed(lambda _, halves: 0.5 * halves)),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, LabelledMethod], None], fault: dict[str, Any]) -> None:
    method = replace(LABELLED_METHODS[EXACT], **fault)
    for check in (law, check_labelled_method):
        with pytest.raises(AssertionError):
            check(EXACT, method)
