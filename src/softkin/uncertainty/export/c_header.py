"""A calibrated model as one C header without dependencies: C99 and its mathematics alone."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from softkin import __version__
from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.c_nodes import c_function, n_targets
from softkin.uncertainty.export.c_robot import (
    bounds_text,
    failures_text,
    features_function,
    inputs_text,
    n_features,
    outside_text,
    space_function,
)
from softkin.uncertainty.export.c_text import Tables, identifier, number
from softkin.uncertainty.export.numbers import LEVELS, exported_numbers

#: Numbers at most of a header: a compiler takes seconds for so many.
MOST_NUMBERS = 4_000_000
RUNTIME = Path(__file__).with_name("runtime.h")

FACE = """
#define @P_COMMANDS {n_commands}
#define @P_COORDINATES {n_coordinates}
#define @P_INPUTS {n_inputs}
/* Levels at which intervals are stored. */
static const double @p_levels[{n_levels}] = {{{levels}}};

/* In {unit}; `outside`: nothing is promised of this command.{failures[0]} */
typedef struct {{
    double position[{n_coordinates}], lower[{n_coordinates}], upper[{n_coordinates}];
    int outside;
{failures[1]}}} @p_answer;

/* Where a robot is in time: inputs of its last command; `session` 0: one never seen. */
typedef struct {{
    double inputs[{n_inputs}];
}} @p_state;
"""
#: What is said of poses that may fail, and where it stands in an answer.
FAILURES = (
    "\n   `failure_probability`: that the pose fails; `may_fail`: more than 1 - level; bounds hold failed poses, too.",
    "    int may_fail;\n    double failure_probability;\n",
)
CALLS = """
/* What is wrong with a call. */
#define @P_OK 0
#define @P_NOT_FINITE 1
#define @P_NO_SUCH_LEVEL 2
#define @P_NO_SUCH_SESSION 3

static inline int @p_level(double level) {{
    for (int place = 0; place < {n_levels}; place++)
        if (fabs(@p_levels[place] - level) < 1e-12) return place;
    return -1;
}}

/* The robot at rest; session 0: one never seen. */
static inline int @p_start(@p_state *state, int session) {{
    return @p_rest(state->inputs, session) ? @P_OK : @P_NO_SUCH_SESSION;
}}

/* Send one command, after those sent since the start. */
static inline int @p_step(@p_state *state, const double *command, double level, @p_answer *answer) {{
    int place = @p_level(level);
    if (!softkin_usable(command, {n_commands})) return @P_NOT_FINITE;
    if (place < 0) return @P_NO_SUCH_LEVEL;
    @p_send(state->inputs, command);
    @p_at(state->inputs, place, answer);
    return @P_OK;
}}

/* One command, sent to a robot at rest in a session never seen. */
static inline int @p_predict(const double *command, double level, @p_answer *answer) {{
    @p_state state;
    @p_start(&state, 0);
    return @p_step(&state, command, level, answer);
}}
"""


def c_header(robot: Any, confidence_levels: Sequence[float] = LEVELS, *, name: str | None = None) -> str:
    """The text of the header; what it defines begins with `name`, by default that of the robot.

    Raises:
        ConfigError: as of `exported_numbers`.
    """
    numbers = exported_numbers(robot, confidence_levels, most=MOST_NUMBERS)
    prefix = identifier(name or robot.dataset)
    tables, n_commands, n_coordinates = Tables(prefix), numbers["n_commands"], len(numbers["coordinates"])
    memory = numbers["memory"]
    n_inputs = n_commands if memory is None else n_commands * (2 + len(memory["halves"])) + 1
    known = {
        "n_commands": n_commands,
        "n_coordinates": n_coordinates,
        "n_inputs": n_inputs,
        "n_levels": len(numbers["levels"]),
        "levels": ", ".join(map(number, numbers["levels"])),
        "unit": _plain(numbers["unit"]),
        "failures": ("", "") if numbers["failures"] is None else FAILURES,
    }
    # Tables and functions are named while the texts are made.
    inputs, at = inputs_text(numbers, tables, n_inputs), _at(numbers, tables, n_coordinates)
    parts = [
        RUNTIME.read_text(encoding="utf-8"),
        f"#ifndef @P_H\n#define @P_H\n/* {_head(numbers)} */",
        FACE.format(**known),
        "\n".join(tables.texts),
        "\n\n".join(tables.functions),
        inputs,
        at,
        CALLS.format(**known),
        "#endif",
    ]
    return "\n".join(part.strip("\n") for part in parts).replace("@P", prefix.upper()).replace("@p", prefix) + "\n"


def _head(numbers: Node) -> str:
    text = (
        f"{numbers['dataset']}: {numbers['model']}; written by softkin {__version__}.\n"
        f"   Commands: {', '.join(numbers['commands'])}. "
        f"Coordinates in {numbers['unit']}: {', '.join(numbers['coordinates'])}.\n"
        "   @p_predict(command, level, &answer) is 0 where all is well; link with -lm."
    )
    text += f"\n   {numbers['known_to']}" if numbers["known_to"] else ""
    return _plain(text)


def _plain(text: str) -> str:
    """A text that ends no comment."""
    return text.encode("ascii", "replace").decode().replace("*/", "* /")


def _at(numbers: Node, tables: Tables, n_coordinates: int) -> str:
    """The function that answers inputs at a level."""
    members = [
        _member(member, share, tables, numbers)
        for share, member in zip(numbers["shares"], numbers["members"], strict=True)
    ]
    zero = tables.name(np.asarray(numbers["zero"], dtype=np.float64))
    return "\n".join(
        [
            "static inline void @p_at(const double *inputs, int level, @p_answer *answer) {",
            f"    double spread[{n_coordinates}], norm, sides[{n_coordinates}][2];",
            f"    for (int i = 0; i < {n_coordinates}; i++) answer->position[i] = spread[i] = 0.0;",
            *members,
            f"    for (int i = 0; i < {n_coordinates}; i++) answer->position[i] += @p_zero(inputs, i) + {zero}[i];",
            outside_text(numbers, tables),
            bounds_text(numbers, tables, n_coordinates),
            failures_text(numbers, tables, n_coordinates),
            "}",
        ]
    )


def _member(member: Node, share: float, tables: Tables, numbers: Node) -> str:
    """Lines that add what one member says to the position."""
    n_commands, n_coordinates = numbers["n_commands"], len(numbers["coordinates"])
    n, function = n_targets(member["regressor"]), c_function(member["regressor"], tables)
    told = features_function(member, tables, n_commands)
    space = space_function(member["space"], tables, n_coordinates)
    return f"""    {{
        double y[{n}], s[{n}], place[{n_coordinates}], features[{n_features(member, n_commands)}];
        {told}(inputs, features);
        for (int i = 0; i < {n}; i++) s[i] = 0.0;
        {function}(features, y, s);
        {space}(y, s, place, spread);
        for (int i = 0; i < {n_coordinates}; i++) answer->position[i] += {number(share)} * place[i];
    }}"""
