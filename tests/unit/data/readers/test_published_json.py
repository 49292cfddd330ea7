from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.errors import DataError
from softkin.core.samples import MAX_MAGNITUDE, SUBSETS, Samples
from softkin.data.readers.published_json import read
from tests.conftest import four_subsets, published_json

GOOD = published_json(four_subsets(dict.fromkeys(SUBSETS, 4)))


def parse(path: Path, content: Any) -> dict[str, Samples]:
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return read(path, dataset="finger", source={"n_commands": 2, "n_markers": 1})


def spoil(change: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(json.dumps(GOOD))
    change(content)
    return content


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda c: c.pop("val"), ["'val'", "missing"]),
        (lambda c: c["ext"].pop("position"), ["'ext'", "'position'", "missing"]),
        (lambda c: c["test"].update(position=[]), ["'test'", "'position'", "empty"]),
        (lambda c: c["train"]["position"].pop(), ["'train'", "different length"]),
        (lambda c: c["train"]["motor_control"][2].append(1.0), ["row 2", "wrong shape", "3 values"]),
        (lambda c: c["train"]["position"][1][0].pop(), ["'position'", "row 1", "wrong shape"]),
        (lambda c: c["test"]["position"][3][0].__setitem__(1, "12.5"), ["'test'", "row 3", "expected a number"]),
        (lambda c: c["test"]["position"][3][0].__setitem__(1, None), ["row 3", "expected a number", "null"]),
        (lambda c: c["test"]["position"][0][0].__setitem__(1, True), ["row 0", "expected a number"]),
        (lambda c: c["val"]["motor_control"][0].__setitem__(0, float("nan")), ["'val'", "row 0", "not finite"]),
        (lambda c: c["val"]["motor_control"][0].__setitem__(0, float("inf")), ["'val'", "row 0", "not finite"]),
    ],
)
def test_a_bad_file_is_named_with_dataset_subset_field_and_row(
    tmp_path: Path, change: Callable[[dict[str, Any]], Any], says: list[str]
) -> None:
    with pytest.raises(DataError) as error:
        parse(tmp_path / "raw.json", spoil(change))
    for part in ("finger", "\n  fix: ", *says):
        assert part in str(error.value)


@pytest.mark.parametrize("content", ["", "{", "[]", '"text"', "\x00"])
def test_what_is_no_json_object_is_an_error(tmp_path: Path, content: str) -> None:
    with pytest.raises(DataError, match="finger"):
        parse(tmp_path / "raw.json", content)


finite = st.floats(-MAX_MAGNITUDE, MAX_MAGNITUDE)


@given(arrays(float, (3, 2), elements=finite), arrays(float, (3, 3), elements=finite))
def test_every_finite_number_survives_to_the_bit(
    tmp_path_factory: pytest.TempPathFactory, commands: Any, positions: Any
) -> None:
    subsets = dict.fromkeys(SUBSETS, Samples(commands, positions))
    read_back = parse(tmp_path_factory.mktemp("json") / "raw.json", published_json(subsets))
    for rows in read_back.values():
        np.testing.assert_array_equal(rows.commands, commands)
        np.testing.assert_array_equal(rows.positions, positions)
