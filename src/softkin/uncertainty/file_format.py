"""The format of the file of a calibrated model: what is in it, and which files are refused."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from softkin.core.errors import ResultError

#: Raised by one when what is in the file changes. A file of another format is refused.
FORMAT = 5


def stored_state(robot: Any) -> dict[str, Any]:
    """What is stored of a calibrated model: the format and its fields, none of what is worked out from them."""
    return {"format": FORMAT} | {one.name: getattr(robot, one.name) for one in fields(robot)}


def restore(robot: Any, state: Any) -> None:
    """Fill a calibrated model from what was stored.

    Raises:
        ResultError: it is of another format.
    """
    number = state.get("format", 1) if isinstance(state, dict) else 1
    if number != FORMAT:
        raise ResultError(
            f"a calibrated model of format {number}, where this version of softkin reads {FORMAT}",
            fix="run the workflow again with this version, or use the version that wrote it",
        )
    robot.__dict__.update({one.name: state[one.name] for one in fields(robot)})
