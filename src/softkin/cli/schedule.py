"""Make what starts a campaign every day, for this folder and ready to install, and say how to install it.

    python -m softkin.cli.schedule --at 03:17 --kind systemd

docs/schedules.md says what each does with the verdict.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from softkin.campaigns.schedules import FOLDER, KINDS, Schedule, texts
from softkin.core.errors import SoftkinError
from softkin.core.files import write_text

ALL = "all"
HOW = {
    ".timer": "systemd: cp {folder}/{stem}.service {folder}/{stem}.timer ~/.config/systemd/user/ &&"
    " systemctl --user daemon-reload && systemctl --user enable --now {stem}.timer && loginctl enable-linger",
    ".cron": "cron: {{ crontab -l; cat {folder}/{stem}.cron; }} | crontab -",
    ".yml": "GitHub: commit a copy of {folder}/{stem}.yml in .github/workflows of the repository",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the files, say what to do with them; return the exit code."""
    parser = argparse.ArgumentParser(prog="softkin.cli.schedule", allow_abbrev=False, description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    parser.add_argument("--at", default="03:17", help="time of the day; 03:17 by default (GitHub: UTC, else local)")
    parser.add_argument("--kind", choices=[ALL, *KINDS], default=ALL, help="all by default")
    parser.add_argument("--cores", type=int, default=2, help="jobs at a time; 2 by default")
    parser.add_argument("--notify", help="command that gets the verdict on its standard input")
    parser.add_argument("--directory", type=Path, default=Path(), help="the project; this folder by default")
    asked = parser.parse_args(arguments)
    folder = asked.directory.resolve()
    try:
        # Not resolved: in an environment the interpreter is a link, and knows its packages by it.
        schedule = Schedule(folder, Path(sys.executable).absolute(), asked.at, asked.cores, asked.notify)
        kinds = KINDS if asked.kind == ALL else (asked.kind,)
        for line in write(schedule, kinds):
            print(line)
    except SoftkinError as error:
        print(f"softkin: {error}", file=sys.stderr)
        return 1
    return 0


def write(schedule: Schedule, kinds: Sequence[str]) -> Iterator[str]:
    """Write the files of these kinds into results/schedules, and say how each is installed."""
    target = schedule.folder / FOLDER
    made = texts(schedule, kinds, inside=inside_repository(schedule.folder))
    for name, text in made.items():
        write_text(target / name, text)
    for name in made:
        if (suffix := Path(name).suffix) in HOW:
            yield HOW[suffix].format(folder=FOLDER, stem=Path(name).stem)
    yield f"Variables of your own, such as NOTIFY_URLS='...', go into ~/{schedule.variables_file}: chmod 600"


def inside_repository(folder: Path) -> str:
    """Where a folder is within its Git repository; '.' where it is its top or in none."""
    tops = [parent for parent in (folder, *folder.parents) if (parent / ".git").exists()]
    return folder.relative_to(tops[0]).as_posix() if tops else "."


if __name__ == "__main__":
    sys.exit(main())
