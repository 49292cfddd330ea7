"""Errors that a person can fix: what is wrong, where, and how to fix it."""

from __future__ import annotations

from typing import Self


class SoftkinError(Exception):
    """Bad input of any kind; its text is formatted here and nowhere else.

    `what` says what is wrong; `where` names the file, field or dataset; `fix` says what to do, as an imperative.

    Example:
        >>> from softkin import SoftkinError
        >>> print(SoftkinError("column 'u1' is missing", where="robot.csv", fix="add it, or rename the column"))
        robot.csv: column 'u1' is missing
          fix: add it, or rename the column
    """

    def __init__(self, what: str, *, where: object = None, fix: str | None = None) -> None:
        super().__init__(what)
        self.what = what
        self.where = None if where is None else str(where)
        self.fix = fix

    def __str__(self) -> str:
        place = "" if self.where is None else f"{self.where}: "
        fix = "" if self.fix is None else f"\n  fix: {self.fix}"
        return f"{place}{self.what}{fix}"

    def within(self, place: str) -> Self:
        """The same error, placed in something larger: `where` becomes '<place>, <where>'."""
        return type(self)(self.what, where=place if self.where is None else f"{place}, {self.where}", fix=self.fix)


class ConfigError(SoftkinError):
    """The configuration, or what it asks for, cannot be used."""


class DataError(SoftkinError):
    """The rows, columns or values of a dataset cannot be used."""


class RetrievalError(SoftkinError):
    """A dataset's file cannot be downloaded, or is not the file that was expected."""


class ResultError(SoftkinError):
    """A result file is not what softkin wrote."""


class StoreError(SoftkinError):
    """The MLflow store cannot be opened or does not hold what it should."""
