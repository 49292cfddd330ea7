"""Try the Pythons that softkin promises and that are not the one of `.venv`, where a machine has them.

python -m tools.other_pythons 3.12 3.13

Of each: its environment is installed, the workflow is planned, and the tests of `core` run; of all side by side.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from subprocess import PIPE, STDOUT

HOUSE = Path(__file__).resolve().parents[1]
#: What the tests of `core` need besides the environment of a run.
TESTING = ("pytest", "pytest-timeout", "hypothesis")
ASK = "import sys; print('.'.join(map(str, sys.version_info[:2])))"
#: What is not imported need not be compiled.
PIP = ("-m", "pip", "--quiet", "--disable-pip-version-check", "install", "--no-compile")


def main(versions: Sequence[str], house: Path = HOUSE) -> int:
    """Try each version; the exit code is 1 where one of those that are there failed."""
    with ThreadPoolExecutor() as pool:
        failures = list(pool.map(lambda version: _failed(version, house), versions))
    return int(any(failures))


def _failed(version: str, house: Path) -> bool:
    """Try a version, and say how that ended."""
    python = interpreter(version)
    if python is None:
        print(f"Python {version} is not on this machine", flush=True)
        return False
    started = time.monotonic()
    command, output = first_that_fails(python, house / ".venv" / f"python{version}", house)
    seconds = f"{time.monotonic() - started:.0f} s"
    said = f"Python {version} {f'failed: {command}' if command else 'works'} ({seconds})"
    print("\n".join([said, *output.splitlines()]), flush=True)
    return bool(command)


def interpreter(version: str, environment: Mapping[str, str] = os.environ) -> Path | None:
    """The interpreter of a version such as 3.12: one that the path has, or pyenv; None where none starts."""
    found = shutil.which(f"python{version}", path=environment.get("PATH", ""))
    pyenv = Path(environment.get("PYENV_ROOT", Path.home() / ".pyenv"))
    for python in [*([Path(found)] if found else []), *pyenv.glob(f"versions/{version}.*/bin/python")]:
        asked = subprocess.run([str(python), "-c", ASK], capture_output=True, text=True, check=False)
        if asked.stdout.strip() == version:  # a shim of pyenv may stand for a version that is not chosen
            return python
    return None


def first_that_fails(python: Path, place: Path, house: Path) -> tuple[str, str]:
    """Run all that is tried with an interpreter, in an environment at `place`; the command that fails and its output,
    or nothing.
    """
    for command in commands(python, place, house):
        done = subprocess.run(
            command, cwd=house, env=_environment(house), text=True, stdout=PIPE, stderr=STDOUT, check=False
        )
        if done.returncode != 0:
            return " ".join(command), done.stdout
    return "", ""


def commands(python: Path, place: Path, house: Path) -> Iterator[list[str]]:
    """What is run, one after the other."""
    own = str(place / "bin" / "python")
    pins = (house / "environment-dev.txt").read_text(encoding="utf-8")
    testing = [line for line in pins.splitlines() if re.split("[=;]", line)[0].strip() in TESTING]
    yield [str(python), "-m", "venv", "--clear", str(place)]
    yield [own, *PIP, "--requirement", "environment.txt"]
    yield [own, *PIP, *testing]
    yield [own, "-m", "snakemake", "--dry-run", "--quiet", "--cores", "1"]
    yield [own, "-m", "pytest", "-p", "no:cacheprovider", "tests/unit/core"]


def _environment(house: Path) -> dict[str, str]:
    """With softkin's own code, and nothing of another environment."""
    kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONDONTWRITEBYTECODE")}
    return kept | {"PYTHONPATH": str(house / "src"), "PYTHONNOUSERSITE": "1"}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
