"""Run one unattended campaign: the workflow, what changed since the last one, a verdict, and an exit code.

    python -m softkin.cli.campaign --cores 2

Exit codes: 0 same or better, 1 failed, 3 worse, 4 the data changed in a way that needs a person, 75 another campaign
goes on. results/verdict.json and results/verdict.md say why. NOTIFY_URLS in the environment: URLs of Apprise that get
the verdict.
"""

from __future__ import annotations

import argparse
import os
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path

from softkin.campaigns.verdict import BUSY, EXIT_CODES, FAILED, UNFINISHED, Verdict
from softkin.cli.held_lock import HeldLock
from softkin.cli.notification import take_urls, tell
from softkin.cli.workflow_process import Ended, Stopped, run_workflow, stoppable
from softkin.core.errors import SoftkinError
from softkin.core.explained import explained
from softkin.core.files import write_json, write_text

LOCK, HOLDER = "campaign.lock", "campaign.json"


@dataclass(frozen=True, slots=True)
class Arguments:
    """What a campaign was asked for."""

    cores: int
    snakefile: Path
    directory: Path
    configfile: list[Path]
    refit: bool
    notify: str | None


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a campaign; return its exit code."""
    asked = _parsed(arguments)
    try:
        urls = take_urls()
    except SoftkinError as error:
        print(f"softkin: {error}", file=sys.stderr)
        return EXIT_CODES[FAILED]
    try:
        verdict = _locked(asked)
    except OSError as error:  # of the verdict's files, say
        reason = str(explained(error, ()) or error)
        print(f"softkin: {reason}", file=sys.stderr)
        verdict = Verdict(FAILED, [reason])
    if verdict is None:
        return EXIT_CODES[BUSY]
    print(verdict.as_markdown())
    tell(verdict, command=asked.notify, urls=urls)
    return verdict.exit_code


def _locked(asked: Arguments) -> Verdict | None:
    """Run the campaign under its lock; its verdict, None where another one goes on."""
    os.chdir(asked.directory)  # a store in a file is named from here
    results = asked.directory / "results"
    results.mkdir(parents=True, exist_ok=True)
    lock = HeldLock.of(results / LOCK, HOLDER)
    if not lock.take():
        print(f"softkin: a campaign goes on in {asked.directory}: {lock.holder()}.", file=sys.stderr)
        return None
    try:
        # That of the last campaign would be taken for that of this one, where this one is killed.
        _write(results, Verdict(UNFINISHED, [f"It began at {datetime.now(UTC):%Y-%m-%d %H:%M:%S} UTC."]))
        verdict = _campaign(asked, results)
        _write(results, verdict)
    finally:
        lock.release()
    return verdict


def _write(results: Path, verdict: Verdict) -> None:
    write_json(results / "verdict.json", verdict.as_dict())
    write_text(results / "verdict.md", verdict.as_markdown())


def _campaign(asked: Arguments, results: Path) -> Verdict:
    """Run the workflow, and judge what it left."""
    started = time.time()
    # Loading MLflow takes seconds, in which the workflow sees what is to be done.
    threading.Thread(target=import_module, args=("softkin.cli.judging",), daemon=True).start()
    ended = run_workflow(_command(asked), directory=asked.directory, results=results, refit=asked.refit)
    from softkin.cli import judging

    found = judging.Results(results, started, ended)
    reasons = _reasons(ended, results, started) if ended.exit_code != 0 else []
    try:
        with stoppable():
            return judging.log_failure(found, reasons) if reasons else judging.judge_results(found, refit=asked.refit)
    except Stopped as stopped:
        reasons = [*reasons, f"It was stopped by {stopped} while its results were judged."]
        return Verdict(FAILED, reasons, facts=found.facts())
    except Exception as error:  # of a store, say: the verdict's files tell it where no store can
        known = error if isinstance(error, SoftkinError) else explained(error, ())
        if known is None:
            raise
        return Verdict(FAILED, [*reasons, str(known)], facts=found.facts())


def _command(asked: Arguments) -> list[str]:
    """The command line of Snakemake."""
    command = [sys.executable, "-m", "snakemake", "--cores", str(asked.cores), "--snakefile", str(asked.snakefile)]
    command += ["--directory", str(asked.directory), *(["--forceall"] if asked.refit else [])]
    return [*command, *(["--configfile", *map(str, asked.configfile)] if asked.configfile else [])]


def _reasons(ended: Ended, results: Path, started: float) -> list[str]:
    """Why the workflow failed, in sentences: what its jobs say in their logs, and how it ended."""
    if ended.signal:
        return [f"It was stopped by {ended.signal}."]
    errors = []
    for log in sorted((results / "logs").rglob("*.log")):
        if log.stat().st_mtime < started:
            continue
        lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
        found = [line.split(" ERROR ", 1)[1] for line in lines if " ERROR " in line]
        errors += [f"{log.relative_to(results / 'logs').with_suffix('')}: {found[0]}"] if found else []
    return [*errors, f"The workflow ended with exit code {ended.exit_code}; results/logs and .snakemake/log say more."]


def _parsed(arguments: Sequence[str] | None) -> Arguments:
    parser = argparse.ArgumentParser(prog="softkin.cli.campaign", description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    parser.add_argument("--cores", type=int, default=2, help="jobs at a time; 2 by default")
    parser.add_argument("--snakefile", type=Path, default=Path("Snakefile"), help="of the workflow")
    parser.add_argument("--directory", type=Path, default=Path(), help="folder that results go to; this one by default")
    parser.add_argument("--configfile", type=Path, nargs="+", default=[], help="more configuration, as of Snakemake")
    parser.add_argument("--refit", action="store_true", help="redo everything; the same numbers must come out")
    parser.add_argument("--notify", help="command that gets the verdict on its standard input")
    values = vars(parser.parse_args(arguments))
    for name in ("snakefile", "directory"):
        values[name] = values[name].resolve()
    values["configfile"] = [path.resolve() for path in values["configfile"]]
    return Arguments(**values)


if __name__ == "__main__":
    sys.exit(main())
