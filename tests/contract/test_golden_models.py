"""Calibrated models written by this format's version are read, and answer as they did when they were written."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
import pytest

import softkin
from softkin.core.errors import ResultError
from softkin.core.files import read_json
from softkin.core.samples import Samples
from softkin.uncertainty import file_format
from tests.golden.write import FOLDER, answers

SAID: dict[str, Any] = read_json(FOLDER / "answers.json")


def test_they_are_of_the_format_that_is_written() -> None:
    assert SAID["format"] == file_format.FORMAT, "raised: python -m tests.golden.write"


@pytest.mark.parametrize("name", SAID["robots"])
def test_a_stored_model_answers_as_it_did(name: str) -> None:
    said = dict(SAID["robots"][name])
    robot = softkin.load(FOLDER / f"{name}.joblib", sha256=said.pop("sha256"))
    now = answers(robot)
    assert set(now) == set(said)
    for call, value in said.items():
        np.testing.assert_allclose(now[call], value, rtol=0, atol=1e-9, err_msg=call)


@pytest.mark.parametrize("name", SAID["robots"])
def test_rows_of_a_stored_model_have_all_fields_of_rows(name: str) -> None:
    """Those that came after it was written have their defaults."""
    robot = softkin.load(FOLDER / f"{name}.joblib", trust=True)
    rows = [getattr(robot, field.name) for field in fields(robot)]
    held = [value for value in rows if isinstance(value, Samples)]
    assert held
    for samples in held:
        assert samples.take(slice(3)).orientation is None


def test_a_later_version_refuses_them_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_format, "FORMAT", SAID["format"] + 1)
    with pytest.raises(ResultError, match=f"of format {SAID['format']}, where this version of softkin reads"):
        softkin.load(FOLDER / "curvature.joblib", trust=True)
