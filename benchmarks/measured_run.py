"""Run a command and measure it with all that it starts."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

HOUSE = Path(__file__).resolve().parent.parent


@dataclass(frozen=True, slots=True)
class Measured:
    """Exit status, wall and CPU seconds of a command and its children, largest memory (GB) of any one process."""

    status: int
    wall: float
    cpu: float
    gigabytes: float


def measured_run(command: Sequence[str], stdout: IO[str] | None = None, folder: Path = HOUSE) -> Measured:
    """Run `command` in `folder`, the checkout where left out, with the programs of this environment first in the path,
    and wait for it.
    """
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    start = time.perf_counter()
    process = subprocess.Popen(command, cwd=folder, env=os.environ | {"PATH": path}, stdout=stdout)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)  # already waited for
    wall = time.perf_counter() - start
    return Measured(process.returncode, wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024**2)


def snakemake(folder: Path, *arguments: str) -> list[str]:
    """The command line of a run of the workflow that works in `folder`."""
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(HOUSE / "Snakefile")]
    return [*command, "--directory", str(folder), "--nolock", *arguments]
