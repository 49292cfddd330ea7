from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.explained import LIBRARIES, explained


def of_library(name: str, message: str) -> Exception:
    """An error as if a module of the library had defined it."""
    return type("Refused", (Exception,), {"__module__": f"{name}.exceptions"})(message)


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_librarys_error_is_one_sentence_without_passwords(library: str) -> None:
    error = explained(of_library(library, "\n no http://me:secret@host/x?token=abc \n  File 'a.py'\n"), [])
    assert error is not None
    assert error.what == f"{library} says: no http://***@host/x?token=***"
    assert error.where
    assert error.fix


def test_a_defect_is_not_explained_away() -> None:
    for error in (KeyError("a"), ValueError("b"), ZeroDivisionError(), AssertionError(), OSError("no number")):
        assert explained(error, []) is None


def test_a_damaged_input_goes_first(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("{")
    error = explained(of_library("optuna", "hm"), [tmp_path / "a.json"])
    assert error is not None
    assert error.where == str(tmp_path / "a.json")


def test_an_error_without_words_has_its_name() -> None:
    error = explained(of_library("mlflow", ""), [])
    assert error is not None
    assert error.what == "mlflow says: Refused"
