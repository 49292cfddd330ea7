"""A calibrated model as one Python file that needs numpy alone: its numbers, and the text of what evaluates them."""

from __future__ import annotations

import ast
import inspect
import json
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import Any

from softkin import __version__
from softkin.core.geometry import constant_curvature
from softkin.models.plain import evaluate, expansion, kernels, leaves, spaces, terms
from softkin.uncertainty.export import face
from softkin.uncertainty.export.numbers import LEVELS, exported_numbers
from softkin.uncertainty.plain import may_fail, members, near_errors
from softkin.uncertainty.plain import robot as plain_robot

#: Numbers at most of a Python file, 300 MB.
MOST_NUMBERS = 30_000_000
FUNCTIONS: tuple[Callable[..., Any], ...] = (
    constant_curvature.from_arcs,
    constant_curvature.spread_of_points,
    constant_curvature._sinc,
    constant_curvature._sinc_slope,
)
MODULES: tuple[ModuleType, ...] = (
    kernels,
    expansion,
    leaves,
    terms,
    evaluate,
    spaces,
    members,
    near_errors,
    plain_robot,
    may_fail,
    face,
)
HEAD = '''"""{dataset}: {model}; written by softkin {version}. It needs numpy alone, 2.0 or later.

    from {name} import model
    model.predict(commands)           # positions in {unit}, a row per command: columns {commands}
    model.intervals(commands, 0.9)    # lower and upper bounds in {unit}, at the levels {levels}
    model.is_outside(commands)        # where nothing is promised
{failures}    loop = model.start()              # a control loop: position, lower, upper = loop.step(command)

Coordinates: {coordinates}. {known_to}
"""

from __future__ import annotations

import base64
import json
import zlib
from bisect import bisect_left
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple

import numpy as np

SMALL_ANGLE = {small_angle}

'''

FAILURES = """    model.failure_probability(commands)   # that the pose fails
    model.may_fail(commands, 0.9)     # where that is more than 1 - level: intervals hold failed poses, too
"""


def python_file(robot: Any, confidence_levels: Sequence[float] = LEVELS, *, name: str) -> str:
    """The text of the file; `name` is that of the module, by which it is imported.

    Raises:
        ConfigError: as of `exported_numbers`.
    """
    numbers = exported_numbers(robot, confidence_levels, most=MOST_NUMBERS)
    shown = {key: ", ".join(map(str, numbers[key])) for key in ("commands", "levels", "coordinates")}
    shown |= {key: numbers[key] for key in ("unit", "known_to")}
    head = HEAD.format(
        dataset=_plain(robot.dataset),
        model=numbers["model"],
        version=__version__,
        small_angle=constant_curvature.SMALL_ANGLE,
        name=name,
        failures="" if numbers["failures"] is None else FAILURES,
        **{key: _plain(text) for key, text in shown.items()},
    )
    parts = [*(inspect.getsource(function) for function in FUNCTIONS), *map(_body, MODULES)]
    text = json.dumps(face.encoded(numbers))
    return head + "\n\n".join(parts) + f"\n\n\nNUMBERS = {text!r}\nmodel = read(NUMBERS)\n"


def _body(module: ModuleType) -> str:
    """The text of a module after its imports."""
    text = inspect.getsource(module)
    last = max(node.end_lineno or 0 for node in ast.parse(text).body if isinstance(node, (ast.Import, ast.ImportFrom)))
    return "\n".join(text.splitlines()[last:]).strip() + "\n"


def _plain(text: str) -> str:
    """A text that ends no docstring."""
    return text.encode("ascii", "replace").decode().replace("\\", "/").replace('"', "'")
