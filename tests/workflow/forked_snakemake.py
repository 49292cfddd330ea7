"""Snakemake, imported once and forked for each command line: a small run takes less time than these imports.

    python tests/workflow/forked_snakemake.py

Reads a JSON object a line, `arguments` (after `snakemake`), `environment`, `folder` to start in, `executable`, the
interpreter of the jobs, and `output` and `errors`, the files that get what is written; answers each by a line with the
exit status. No module of softkin is imported before the fork: each command line finds the source that its environment
names.
"""

from __future__ import annotations

import atexit
import importlib
import json
import os
import sys
from typing import Any

#: What Snakemake imports when it starts, and later in a dry run.
IMPORTED = (
    *("snakemake.cli", "snakemake.report.html_reporter", "snakemake.storage", "nbformat", "numpy", "filelock"),
    *("smart_open", "requests", "difflib", "graphlib", "statistics", "platformdirs"),
)


def run(
    arguments: list[str], environment: dict[str, str], folder: str, executable: str, output: str, errors: str
) -> None:
    """Run one command line in this process, which ends with it."""
    for place, (name, mode) in enumerate([(os.devnull, "rb"), (output, "wb"), (errors, "ab")]):
        with open(name, mode) as file:
            os.dup2(file.fileno(), place)
    sys.executable = executable
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    sys.path[:0] = environment["PYTHONPATH"].split(os.pathsep)
    sys.argv = ["snakemake", *arguments]
    sys.modules["snakemake.cli"].main(arguments)


def exit_status(request: dict[str, Any]) -> int:
    """That of a command line run in a fork of this process."""
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    status = 1
    try:
        run(**request)
    except SystemExit as ended:
        status = ended.code if isinstance(ended.code, int) else int(ended.code is not None)
    finally:
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


if __name__ == "__main__":
    for name in IMPORTED:
        importlib.import_module(name)
    for line in sys.stdin:
        print(exit_status(json.loads(line)), flush=True)
