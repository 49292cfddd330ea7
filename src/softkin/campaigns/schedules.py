"""Texts of schedules that start a campaign every day: a systemd service and its timer, a line for cron, a workflow of
GitHub Actions. Each names its folder in full, and gives the campaign the environment that it needs and no more.

They call the command behind `make campaign`, since make ends with 2 whatever its command ends with.
"""

from __future__ import annotations

import hashlib
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from softkin.campaigns.github_actions import github_workflow
from softkin.core.errors import ConfigError

#: What is made.
KINDS = ("systemd", "cron", "github")
#: Where programs are looked for: git, and what a notification calls.
PATH = "/usr/local/bin:/usr/bin:/bin"
#: As the Makefile sets them.
VARIABLES = {"PATH": PATH, "OMP_NUM_THREADS": "1", "MLFLOW_DISABLE_TELEMETRY": "true"}
#: What the extra `notify` installs.
APPRISE = "apprise==2.3.0"
#: Where schedules are written, in the project.
FOLDER = Path("results") / "schedules"
#: Debian's cron (3.0pl1) takes no longer command.
LONGEST_COMMAND = 998
#: Characters that no line of a schedule can hold: controls, and bytes that are no UTF-8.
UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")
#: Of systemd: an outcome that a person looks at, and no failure of the service.
NO_FAILURES = "3 4"


@dataclass(frozen=True, slots=True)
class Schedule:
    """What is started when.

    Parameters:
        folder: the project, an absolute path.
        python: its interpreter, an absolute path.
        time: of the day, 'HH:MM'.
        cores: jobs at a time; 2 by default.
        notify: command that gets the verdict on its standard input; None for none.
    """

    folder: Path
    python: Path
    time: str
    cores: int = 2
    notify: str | None = None

    def __post_init__(self) -> None:
        if not re.fullmatch(r"([01][0-9]|2[0-3]):[0-5][0-9]", self.time):
            raise ConfigError(
                f"{self.time!r} is no time of the day",
                where="AT",
                fix="give hours and minutes, such as make schedule AT=03:17",
            )
        for name, text in {"the folder": str(self.folder), "NOTIFY": self.notify or ""}.items():
            if UNPRINTABLE.search(text):
                raise ConfigError(
                    "it has a line break or another character that no schedule can hold", where=name, fix="rename it"
                )

    @property
    def name(self) -> str:
        """softkin-<folder>-<hash>: schedules of several folders do not meet."""
        readable = re.sub(r"[^a-z0-9]+", "-", self.folder.name.lower()).strip("-")
        digest = hashlib.sha256(str(self.folder).encode()).hexdigest()
        return "-".join(filter(None, ["softkin", readable[:30], digest[:6]]))

    @property
    def variables_file(self) -> str:
        """The file of the user's own variables, within the home folder: lines such as NOTIFY_URLS='...'."""
        return f".config/softkin/{self.name}.env"

    def command(self) -> list[str]:
        """The command behind `make campaign`."""
        told = [f"--notify={self.notify}"] if self.notify else []
        made = [str(self.python), "-m", "softkin.cli.campaign", f"--cores={self.cores}"]
        return [*made, f"--directory={self.folder}", f"--snakefile={self.folder / 'Snakefile'}", *told]


def systemd_service(schedule: Schedule) -> str:
    """The service: one campaign. A verdict of exit code 3 or 4 is no failure of the service; 1 and 75 are."""
    # A shell takes the path of the interpreter as an argument: in the first word systemd would leave $$ as it is.
    command = ["-c", 'exec "$@"', schedule.name, *schedule.command()]
    lines = [
        "[Unit]",
        f"Description=softkin: one campaign in {_specifiers(str(schedule.folder))}.",
        "",
        "[Service]",
        "Type=oneshot",
        *(f"Environment={_systemd(f'{name}={value}')}" for name, value in VARIABLES.items()),
        'Environment="HOME=%h"',
        f"EnvironmentFile=-%h/{schedule.variables_file}",
        f"ExecStart=/bin/sh {' '.join(_systemd(word).replace('$', '$$') for word in command)}",
        f"SuccessExitStatus={NO_FAILURES}",
        "# A campaign ends its jobs itself, within 30 seconds.",
        "KillMode=mixed",
        "TimeoutStopSec=60",
    ]
    return "\n".join(lines) + "\n"


def systemd_timer(schedule: Schedule) -> str:
    """The timer of the service, by local time; a night on which the machine was off is made up for."""
    return f"""\
[Unit]
Description=softkin: every day a campaign in {_specifiers(str(schedule.folder))}.

[Timer]
OnCalendar=*-*-* {schedule.time}:00
Persistent=true

[Install]
WantedBy=timers.target
"""


def cron_line(schedule: Schedule) -> str:
    """The line for `crontab -e`, by local time. Cron passes HOME; the screen goes to a log.

    Raises:
        ConfigError: it is longer than cron takes.
    """
    file = f'"$HOME/{schedule.variables_file}"'
    log = shlex.quote(str(schedule.folder / FOLDER / "cron.log"))
    given = " ".join(f"{name}={shlex.quote(value)}" for name, value in VARIABLES.items())
    read = f"if [ -r {file} ]; then set -a; . {file}; set +a; fi"
    command = f"{read}; {given} {shlex.join(schedule.command())} >{log} 2>&1".replace("%", "\\%")
    if len(command.encode()) > LONGEST_COMMAND:
        raise ConfigError(
            f"the line has {len(command.encode())} bytes, and cron takes {LONGEST_COMMAND}",
            where=schedule.folder,
            fix="use KIND=systemd, or a folder with a shorter path",
        )
    hour, minute = map(int, schedule.time.split(":"))
    return f"{minute} {hour} * * * {command}\n"


def texts(schedule: Schedule, kinds: Sequence[str], inside: str = ".") -> Mapping[str, str]:
    """Name of each file -> its text.

    Parameters:
        schedule: what is started when.
        kinds: of `KINDS`.
        inside: the project's folder within its repository.
    """
    made = {
        "systemd": lambda: {
            f"{schedule.name}.service": systemd_service(schedule),
            f"{schedule.name}.timer": systemd_timer(schedule),
        },
        "cron": lambda: {f"{schedule.name}.cron": cron_line(schedule)},
        "github": lambda: {
            f"{schedule.name}.yml": github_workflow(
                schedule.time,
                schedule.cores,
                notify=schedule.notify,
                variables={name: value for name, value in VARIABLES.items() if name != "PATH"},
                apprise=APPRISE,
                inside=inside,
            )
        },
    }
    return {name: text for kind in kinds for name, text in made[kind]().items()}


def _specifiers(text: str) -> str:
    """Text in which systemd finds no specifier."""
    return text.replace("%", "%%")


def _systemd(word: str) -> str:
    """One word of a command or an assignment, as systemd reads it between quotes."""
    escaped = word.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{_specifiers(escaped)}"'
