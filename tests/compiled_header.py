"""An exported C header, compiled and asked: commands go in and answers come out as bytes."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from softkin.core.samples import Array

FLAGS = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
PROGRAM = """
#include "{name}.h"
#include <stdio.h>

int main(int argc, char **argv) {{
    double command[{upper}_COMMANDS], wanted;
    {name}_answer answer;
    {name}_state state;
    int session = 0;
    (void)argv;
    if (fread(&wanted, sizeof wanted, 1, stdin) != 1) return 2;
    if (fread(&session, sizeof session, 1, stdin) != 1) return 2;
    if ({name}_start(&state, session)) return 3;
    while (fread(command, sizeof command, 1, stdin) == 1) {{
        int code = argc > 1 ? {name}_step(&state, command, wanted, &answer) : {name}_predict(command, wanted, &answer);
        if (code) return 10 + code;
        fwrite(&answer, sizeof answer, 1, stdout);
    }}
    return 0;
}}
"""


class Answers(NamedTuple):
    """Positions and bounds (n_rows, n_coordinates), which rows are outside (n_rows,), which may fail, and with what
    probability they do, where failures are known.
    """

    position: Array
    lower: Array
    upper: Array
    outside: np.ndarray
    may_fail: np.ndarray | None = None
    failure_probability: Array | None = None


def compiled(header: str, name: str, folder: Path, optimised: str = "-O0") -> Path:
    """The program that asks a header whose names begin with `name`."""
    (folder / f"{name}.h").write_text(header)
    (folder / f"{name}.c").write_text(PROGRAM.format(name=name, upper=name.upper()))
    command = ["cc", *FLAGS, optimised, f"{name}.c", "-o", name, "-lm"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    return folder / name


def asked(
    program: Path,
    commands: Array,
    n_coordinates: int,
    *,
    level: float,
    session: int | None = None,
    failures: bool = False,
) -> Answers:
    """Answers to commands (n_rows, n_commands); with a `session` (0: one never seen) sent one after the other; with
    `failures`, of a robot of which some are known.
    """
    sent = np.float64(level).tobytes() + np.int32(session or 0).tobytes() + np.ascontiguousarray(commands).tobytes()
    arguments = [str(program)] if session is None else [str(program), "in order"]
    done = subprocess.run(arguments, input=sent, capture_output=True, check=True)
    fields: list[Any] = [("place", "f8", (3, n_coordinates)), ("outside", "i4")]
    fields += [("may_fail", "i4"), ("failure_probability", "f8")] * failures
    kind = np.dtype(fields, align=True)
    rows = np.frombuffer(done.stdout, kind)
    position, lower, upper = np.moveaxis(rows["place"], 1, 0)
    answers = Answers(position, lower, upper, rows["outside"].astype(bool))
    if not failures:
        return answers
    return answers._replace(
        may_fail=rows["may_fail"].astype(bool), failure_probability=rows["failure_probability"].copy()
    )
