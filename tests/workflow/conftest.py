"""One real run of the workflow on config/test.yaml, on made-up data, shared by all workflow tests."""

from __future__ import annotations

import compileall
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import psutil
import pytest

from tests.conftest import HOUSE

#: Of one run, with the other tests beside it.
MAX_SECONDS = 580
#: The environment under a name with a blank.
VENV = "my venv"
#: Nothing listens there.
NOWHERE = "http://127.0.0.1:9/FINGER.json"


@cache
def forked_snakemake() -> subprocess.Popen[str]:
    """A process that answers command lines, see forked_snakemake.py; it ends with this one."""
    command = [sys.executable, str(Path(__file__).with_name("forked_snakemake.py"))]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@dataclass(frozen=True)
class House:
    """A copy of the repository (`root`), the folder in which it runs (`work`), and the mirror it reads."""

    root: Path
    work: Path
    mirror: Path

    def snakemake(
        self,
        *options: str,
        cores: int = 2,
        work: Path | None = None,
        more: Path | None = None,
        more_environment: Mapping[str, str] | None = None,
    ) -> subprocess.CompletedProcess[str]:
        """Run the workflow; `more` is one more configuration file."""
        return subprocess.run(
            self.command(*options, cores=cores, work=work, more=more),
            env=self.environment() | dict(more_environment or {}),
            cwd=self.root,
            capture_output=True,
            text=True,
            check=False,
            timeout=MAX_SECONDS,
        )

    def command(
        self, *options: str, cores: int | None = 2, work: Path | None = None, more: Path | None = None
    ) -> list[str]:
        """The command line of a run; `cores` is None where an executor hands out the jobs."""
        command = [str(self.python), "-m", "snakemake", *(["--cores", str(cores)] if cores else [])]
        command += ["--snakefile", str(self.root / "Snakefile"), "--directory", str(work or self.work), *options]
        configuration = [self.root / "config" / "test.yaml", self.mirror / "override.yaml", *([more] if more else [])]
        return [*command, "--configfile", *map(str, configuration)]

    @property
    def python(self) -> Path:
        """The interpreter: by a path with a blank, where the house has one."""
        beside = self.root.parent / VENV / "bin" / Path(sys.executable).name
        return beside if beside.exists() else Path(sys.executable)

    def environment(self) -> dict[str, str]:
        """The environment variables of a run."""
        return os.environ | {
            "PYTHONPATH": str(self.root / "src"),
            "SOFTKIN_DATA_MIRROR": str(self.mirror),
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        }

    def forked(
        self,
        *options: str,
        cores: int = 2,
        work: Path | None = None,
        more: Path | None = None,
        more_environment: Mapping[str, str] | None = None,
    ) -> subprocess.CompletedProcess[str]:
        """The same in a process that need not import Snakemake."""
        command = self.command(*options, cores=cores, work=work, more=more)
        with tempfile.NamedTemporaryFile() as output, tempfile.NamedTemporaryFile() as errors:
            request = {
                "arguments": command[3:],
                "environment": self.environment() | dict(more_environment or {}),
                "folder": str(self.root),
                "executable": command[0],
                "output": output.name,
                "errors": errors.name,
            }
            forked = forked_snakemake()
            assert forked.stdin is not None
            assert forked.stdout is not None
            try:
                print(json.dumps(request), file=forked.stdin, flush=True)
                status = int(forked.stdout.readline())
            except BaseException:  # the time of a test is up: the next one is answered by another process
                forked.kill()
                forked_snakemake.cache_clear()
                raise
            return subprocess.CompletedProcess(
                command, status, Path(output.name).read_text(), Path(errors.name).read_text()
            )

    def looking(self, *options: str, more: Path | None = None) -> tuple[int, str]:
        """Exit status and output of a command line that starts no job."""
        looked = self.forked(*options, more=more)
        return looked.returncode, looked.stdout + looked.stderr

    def jobs(self, more: Path | None = None) -> list[tuple[str, str]]:
        """(rule, wildcards) of each job that a run would start now."""
        status, output = self.looking("--dry-run", more=more)
        assert status == 0, output
        return jobs_of(output)


def processes(work: Path) -> Iterator[psutil.Process]:
    """The living processes that work in a folder."""
    for process in psutil.process_iter():
        with suppress(psutil.NoSuchProcess, psutil.AccessDenied):
            if process.cwd() == str(work) and process.status() != psutil.STATUS_ZOMBIE:
                yield process


def jobs_of(planned: str) -> list[tuple[str, str]]:
    """(rule, wildcards) of each job that a dry run has printed, but for that of all results."""
    jobs, rule = [], ""
    for line in planned.splitlines():
        if line.startswith(("rule ", "localrule ")):
            rule = line.split()[1].rstrip(":")
            jobs.append((rule, ""))
        elif "wildcards:" in line:
            jobs[-1] = (rule, line.split("wildcards:")[1].strip())
    return [job for job in jobs if job[0] != "all"]


def copy_house(root: Path) -> None:
    """With its bytecode: where none may be written at run time, each job would compile all that it imports anew."""
    root.mkdir()
    for name in ("Snakefile", "CITATION.cff", "config", "workflow", "profiles", "resources", "src"):
        source = HOUSE / name
        if source.is_dir():
            shutil.copytree(source, root / name, ignore=shutil.ignore_patterns("*.egg-info"))
        else:
            shutil.copy(source, root / name)
    compileall.compile_dir(root / "src", quiet=1)  # what is missing or older than its source


@pytest.fixture(scope="session")
def house(tmp_path_factory: pytest.TempPathFactory, mirror: Path) -> House:
    """After one complete run, in folders with blanks and an umlaut in their names."""
    folder = tmp_path_factory.mktemp("house")
    copy_house(folder / "Haus für Roboter")
    (folder / "Arbeit 1").mkdir()
    (folder / VENV).symlink_to(sys.prefix)
    house = House(folder / "Haus für Roboter", folder / "Arbeit 1", mirror)
    done = house.snakemake()
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-5000:]
    (house.work / "first_run.txt").write_text(done.stdout + done.stderr)
    return house
