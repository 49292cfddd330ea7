from __future__ import annotations

import sys
from pathlib import Path

import pytest

from softkin.campaigns.schedules import Schedule
from softkin.cli import schedule


def test_every_kind_is_written_and_how_it_is_installed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = tmp_path / "Roboter für 100 %"
    project.mkdir()
    (tmp_path / ".git").mkdir()
    assert schedule.main(["--directory", str(project), "--at", "23:05", "--notify", "mail me"]) == 0
    name = Schedule(project, Path(sys.executable), "23:05").name
    folder = project / "results" / "schedules"
    assert {path.name for path in folder.iterdir()} == {f"{name}.{end}" for end in ("service", "timer", "cron", "yml")}
    assert f'"{sys.executable}" "-m" "softkin.cli.campaign"' in (folder / f"{name}.service").read_text()
    assert (folder / f"{name}.cron").read_text().startswith("5 23 * * * ")
    assert 'working-directory: "Roboter für 100 %"' in (folder / f"{name}.yml").read_text()
    assert all("--notify=mail me" in path.read_text() for path in folder.glob(f"{name}.[sc]*"))
    printed = capsys.readouterr().out
    assert f"systemctl --user enable --now {name}.timer" in printed
    assert f"cat results/schedules/{name}.cron; }} | crontab -" in printed
    assert f"~/.config/softkin/{name}.env: chmod 600" in printed


def test_one_kind_is_what_was_asked_for(tmp_path: Path) -> None:
    assert schedule.main(["--directory", str(tmp_path), "--kind", "cron"]) == 0
    assert [path.suffix for path in (tmp_path / "results" / "schedules").iterdir()] == [".cron"]


def test_a_wrong_time_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert schedule.main(["--directory", str(tmp_path), "--at", "late"]) == 1
    assert capsys.readouterr().err.startswith("softkin: AT: 'late' is no time of the day\n  fix: ")
    assert not (tmp_path / "results").exists()


def test_a_project_outside_git_is_its_own_top(tmp_path: Path) -> None:
    assert schedule.inside_repository(tmp_path) == "."
