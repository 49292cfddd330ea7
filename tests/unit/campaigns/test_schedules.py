"""What is generated is read by systemd, cron and a shell as it is meant, in a folder of any name."""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from softkin.campaigns.schedules import (
    KINDS,
    LONGEST_COMMAND,
    Schedule,
    cron_line,
    systemd_service,
    systemd_timer,
    texts,
)
from softkin.core.errors import ConfigError

#: Each means something to systemd, cron or a shell.
FOLDERS = (
    "plain",
    "two  blanks",
    "Roboter für Ärzte",
    "100 %h %% \\%",
    "a$HOME ${PATH} $$",
    "a 'b' \"c\" \\t `d` #e",
    "a=b",
    ";",
)
NOTIFY = 'printf "%s\\n" "$SOFTKIN_OUTCOME" | tee \'a b\' # 100 %'
RECORD = '#!/bin/sh\nfor word in "$0" "$@"; do printf "%s\\0" "$word" >> "$HOME/heard"; done\nenv > "$HOME/variables"\n'


@pytest.fixture(params=FOLDERS)
def schedule(request: pytest.FixtureRequest, tmp_path: Path) -> Schedule:
    """That of a project whose interpreter writes down its arguments and its environment in the home folder."""
    folder = tmp_path / request.param
    python = folder / ".venv" / "bin" / "python"
    python.parent.mkdir(parents=True)
    (folder / "results" / "schedules").mkdir(parents=True)
    python.write_text(RECORD)
    python.chmod(0o755)
    schedule = Schedule(folder, python, "03:17", cores=3, notify=NOTIFY)
    variables = tmp_path / "home" / schedule.variables_file
    variables.parent.mkdir(parents=True)
    variables.write_text("NOTIFY_URLS='json://one json://two'\n")
    return schedule


def started(command: list[str], home: Path, **environment: str) -> dict[str, str]:
    """Start a command with these variables and HOME alone; the variables that the interpreter saw."""
    subprocess.run(command, env={"HOME": str(home), **environment}, cwd=home, check=True)
    return dict(line.split("=", 1) for line in (home / "variables").read_text().splitlines() if "=" in line)


def read_as_systemd(line: str) -> list[str]:
    """The words of ExecStart= as systemd.service(5) says: quotes, backslashes, specifiers, variables."""
    words = [
        re.sub(r"\\(.)", r"\1", quoted) if quoted else plain
        for quoted, plain in re.findall(r'"((?:[^"\\]|\\.)*)"|(\S+)', line)
    ]
    for word in words:
        assert not re.search(r"%[^%]", word.replace("%%", "")), "a specifier"
        assert not re.search(r"\$[^$]", word.replace("$$", "")), "a variable"
    return [word.replace("%%", "%").replace("$$", "$") for word in words]


def read_as_cron(line: str) -> tuple[str, str]:
    """The time, and the command as Debian's cron gives it to the shell: `\\%` is %, and % alone would end it."""
    time, command = " ".join(line.split(" ", 5)[:5]), line.rstrip("\n").split(" ", 5)[5]
    assert not re.search(r"(?<!\\)%", command)
    return time, command.replace("\\%", "%")


def expected(schedule: Schedule) -> list[str]:
    options = ["--cores=3", f"--directory={schedule.folder}", f"--snakefile={schedule.folder}/Snakefile"]
    return [str(schedule.python), "-m", "softkin.cli.campaign", *options, f"--notify={NOTIFY}"]


def test_a_service_starts_the_campaign_with_its_own_environment(schedule: Schedule, tmp_path: Path) -> None:
    text, home = systemd_service(schedule), tmp_path / "home"
    lines = dict(
        line.split("=", 1) for line in text.splitlines() if "=" in line and not line.startswith("Environment=")
    )
    given = [line.split("=", 1)[1].strip('"') for line in text.splitlines() if line.startswith("Environment=")]
    environment = dict(assignment.split("=", 1) for assignment in given)
    assert environment.pop("HOME") == "%h"
    seen = started(read_as_systemd(lines["ExecStart"]), home, **environment)
    assert (home / "heard").read_text().split("\0")[:-1] == expected(schedule)
    assert set(seen) - {"PWD", "SHLVL", "_"} == {"HOME", "PATH", "OMP_NUM_THREADS", "MLFLOW_DISABLE_TELEMETRY"}
    assert lines["EnvironmentFile"] == f"-%h/{schedule.variables_file}"
    assert lines["SuccessExitStatus"] == "3 4"


def test_cron_starts_the_campaign_with_its_own_environment(schedule: Schedule, tmp_path: Path) -> None:
    time, command = read_as_cron(cron_line(schedule))
    assert time == "17 3 * * *"
    seen = started(["/bin/sh", "-c", command], tmp_path / "home", PATH="/usr/bin:/bin", LOGNAME="me", SHELL="/bin/sh")
    assert (tmp_path / "home" / "heard").read_text().split("\0")[:-1] == expected(schedule)
    assert seen["NOTIFY_URLS"] == "json://one json://two"
    assert seen["PATH"].startswith("/usr/local/bin:")
    assert (schedule.folder / "results" / "schedules" / "cron.log").exists()
    assert {path.name for path in (tmp_path / "home").iterdir()} == {"heard", "variables", ".config"}


def test_systemd_has_nothing_to_say_against_the_units(schedule: Schedule, tmp_path: Path) -> None:
    if shutil.which("systemd-analyze") is None:
        pytest.skip("systemd-analyze is not installed: apt-get install systemd")
    units = [tmp_path / name for name in texts(schedule, ["systemd"])]
    for unit in units:
        unit.write_text(texts(schedule, ["systemd"])[unit.name])
    environment = os.environ | {"XDG_RUNTIME_DIR": str(tmp_path), "HOME": str(tmp_path)}
    done = subprocess.run(
        ["systemd-analyze", "--user", "--recursive-errors=no", "verify", *map(str, units)],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def test_systemd_reads_the_time(tmp_path: Path) -> None:
    if shutil.which("systemd-analyze") is None:
        pytest.skip("systemd-analyze is not installed: apt-get install systemd")
    timer = systemd_timer(Schedule(tmp_path, tmp_path / "python", "23:05"))
    calendar = re.search("^OnCalendar=(.*)$", timer, re.MULTILINE)
    assert calendar is not None
    done = subprocess.run(["systemd-analyze", "calendar", calendar[1]], capture_output=True, text=True, check=True)
    assert re.search(r"Next elapse: .* 23:05:00 ", done.stdout)


def test_a_crontab_parser_reads_the_time(tmp_path: Path) -> None:
    if importlib.util.find_spec("cronsim") is None:
        pytest.skip("cronsim is not installed: make test installs it")
    from datetime import datetime

    cronsim: Any = importlib.import_module("cronsim")
    time = " ".join(cron_line(Schedule(tmp_path, tmp_path / "python", "23:05")).split(" ", 5)[:5])
    coming = cronsim.CronSim(time, datetime(2026, 11, 26, 12))
    assert [next(coming) for _ in range(2)] == [datetime(2026, 11, 26, 23, 5), datetime(2026, 11, 27, 23, 5)]


def test_cron_takes_the_line(schedule: Schedule, tmp_path: Path) -> None:
    if shutil.which("crontab") is None:
        pytest.skip("crontab is not installed: apt-get install cron")
    (tmp_path / "table").write_text(cron_line(schedule))
    done = subprocess.run(["crontab", "-n", str(tmp_path / "table")], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_what_cron_would_cut_off_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / ("x" * LONGEST_COMMAND)
    with pytest.raises(ConfigError, match="cron takes 998") as error:
        cron_line(Schedule(folder, folder / "python", "03:17"))
    assert "KIND=systemd" in str(error.value)


@pytest.mark.parametrize("time", ["3:17", "24:00", "03:60", "noon", "03:17\n", ""])
def test_what_is_no_time_of_the_day_is_refused(tmp_path: Path, time: str) -> None:
    with pytest.raises(ConfigError, match=r"is no time of the day"):
        Schedule(tmp_path, tmp_path / "python", time)


def test_what_no_line_can_hold_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="the folder: it has a line break"):
        Schedule(tmp_path / "a\nb", tmp_path / "python", "03:17")
    with pytest.raises(ConfigError, match="NOTIFY: it has a line break"):
        Schedule(tmp_path, tmp_path / "python", "03:17", notify="mail\nme")


def test_schedules_of_two_folders_do_not_meet(tmp_path: Path) -> None:
    names = [set(texts(Schedule(tmp_path / name / "arm", tmp_path, "03:17"), KINDS)) for name in ("a", "b")]
    assert not names[0] & names[1]
    assert len(names[0]) == 4
