from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from softkin.core.errors import ConfigError, DataError, RetrievalError, SoftkinError, StoreError

FAMILIES = [ConfigError, DataError, RetrievalError, StoreError]


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (SoftkinError("no rows"), "no rows"),
        (SoftkinError("no rows", where="arm.csv"), "arm.csv: no rows"),
        (SoftkinError("no rows", fix="export it again"), "no rows\n  fix: export it again"),
        (SoftkinError("no rows", where=Path("a/b"), fix="export it"), "a/b: no rows\n  fix: export it"),
    ],
)
def test_the_text_is_place_problem_and_fix(error: SoftkinError, text: str) -> None:
    assert str(error) == text


@pytest.mark.parametrize("family", FAMILIES)
def test_a_caller_tells_the_families_apart(family: type[SoftkinError]) -> None:
    with pytest.raises(SoftkinError) as error:
        raise family("what", where="where", fix="fix")
    assert [other for other in FAMILIES if isinstance(error.value, other)] == [family]


@pytest.mark.parametrize("family", FAMILIES)
def test_an_error_keeps_its_parts_across_processes(family: type[SoftkinError]) -> None:
    error = pickle.loads(pickle.dumps(family("what", where="where", fix="fix")))
    assert type(error) is family
    assert (error.what, error.where, error.fix) == ("what", "where", "fix")


def test_an_error_is_placed_in_something_larger() -> None:
    inner = DataError("no value", where="line 3", fix="fill the cell")
    outer = inner.within("file arm.csv").within("dataset 'arm'")
    assert type(outer) is DataError
    assert str(outer) == "dataset 'arm', file arm.csv, line 3: no value\n  fix: fill the cell"
    assert (outer.what, outer.fix) == (inner.what, inner.fix)
    assert inner.where == "line 3"


def test_an_error_without_a_place_gets_one() -> None:
    assert str(ConfigError("no value").within("file arm.csv")) == "file arm.csv: no value"
