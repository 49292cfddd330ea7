"""Let one run of the workflow at a time work in a folder, and clear what a run that was killed has left there.

Snakemake's own lock outlives a run that was killed, and does not stop a second run for other files. The lock here is
held by the process of a run and freed by the system when it ends, however it ends.
"""

from __future__ import annotations

import shutil
import signal
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import psutil

from softkin.cli.held_lock import HeldLock
from softkin.core.errors import ConfigError

#: The lock and what is known of who holds it, in the folder that Snakemake keeps its records in.
LOCK, HOLDER = "softkin.lock", "softkin_run.json"
#: Snakemake writes the scripts that it runs here.
SCRIPTS = ".snakemake/scripts/"
#: Options by which Snakemake only looks.
ONLY_LOOKING = {
    *("-n", "--dry-run", "--dryrun", "--lint", "--report", "--summary", "--detailed-summary", "-D", "-S"),
    *("--list-rules", "-l", "--list", "--rulegraph", "--dag", "--d3dag", "--filegraph", "--list-code-changes"),
    *("--list-params-changes", "--list-input-changes", "--containerize"),
}
#: Seconds that a run waits for another one to end, and an orphan is given to end by itself.
PATIENCE, GRACE = 5.0, 5.0


@dataclass(frozen=True, slots=True)
class OneRun:
    """The right to run in a folder. `take` takes it; it ends with the process."""

    folder: Path
    lock: HeldLock

    @classmethod
    def of(cls, folder: str | Path) -> OneRun:
        """That of a folder, not taken yet."""
        records = Path(folder).resolve() / ".snakemake"
        records.mkdir(parents=True, exist_ok=True)
        return cls(records.parent, HeldLock.of(records / LOCK, HOLDER))

    def take(self, patience: float = PATIENCE) -> list[str]:
        """Take it, and return in sentences what was cleared.

        Raises:
            ConfigError: another run goes on; it says since when.
        """
        if not self.lock.take(patience):
            raise ConfigError(
                f"another run of softkin goes on here, {self.lock.holder()}",
                where=self.folder,
                fix="wait until it has ended, or end it by Ctrl-C where it runs",
            )
        return clear(self.folder)


def clear(folder: str | Path) -> list[str]:
    """End the jobs, and remove the locks and half files, that a killed run left in a folder; say in sentences what."""
    folder, done = Path(folder).resolve(), []
    orphans = end(orphans_of(folder))
    if orphans:
        done.append(f"ended {len(orphans)} jobs that a killed run had left running")
    locks = folder / ".snakemake" / "locks"
    if locks.exists() and any(locks.iterdir()):
        shutil.rmtree(locks)
        done.append("removed the lock of a killed run")
    halves = [path for path in (folder / "results").rglob(".*.part") if path.is_file()]
    for path in halves:
        path.unlink()
    if halves:
        done.append(f"removed {len(halves)} half-written files")
    return done


def orphans_of(folder: Path) -> list[psutil.Process]:
    """The jobs of Snakemake that run in a folder and whose Snakemake is gone."""
    found = []
    for process in psutil.process_iter():
        try:
            here = process.cwd() == str(folder) and any(SCRIPTS in part for part in process.cmdline())
            if here and not any("snakemake" in " ".join(parent.cmdline()) for parent in process.parents()):
                found.append(process)
        except (psutil.NoSuchProcess, psutil.AccessDenied):
            continue
    return found


def end(processes: Sequence[psutil.Process], grace: float = GRACE) -> Sequence[psutil.Process]:
    """End processes and all their children, by force those that have not ended after `grace` seconds."""
    family = [*processes]
    for process in processes:
        try:
            family += process.children(recursive=True)
        except psutil.NoSuchProcess:
            continue
    for process in family:
        _send(process, signal.SIGTERM)
    _, alive = psutil.wait_procs(family, timeout=grace)
    for process in alive:
        _send(process, signal.SIGKILL)
    psutil.wait_procs(alive, timeout=grace)
    return processes


def _send(process: psutil.Process, number: signal.Signals) -> None:
    try:
        process.send_signal(number)
    except psutil.NoSuchProcess:
        return


def only_looks(arguments: Sequence[str]) -> bool:
    """Whether a command line of Snakemake runs no job."""
    return any(argument.split("=")[0] in ONLY_LOOKING for argument in arguments)
