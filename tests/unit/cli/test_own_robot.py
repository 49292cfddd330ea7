from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.cli.own_robot import guess_and_run
from softkin.core.errors import ConfigError


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a configuration and the file of a robot; it is the working folder."""
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "config.yaml").write_text("datasets: [finger]\n")
    (tmp_path / "config" / "datasets.yaml").write_text("sources:\n  finger: {}\n")
    rng = np.random.default_rng(0)
    u = rng.uniform(0, 1, (200, 2))
    poses = {f"tip_{axis}_mm": u @ weights for axis, weights in zip("xyz", rng.normal(0, 30, (3, 2)), strict=True)}
    pd.DataFrame({"pressure_1": u[:, 0], "pressure_2": u[:, 1], **poses}).to_csv(tmp_path / "My arm.csv", index=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def asked(monkeypatch: pytest.MonkeyPatch, answer: str, *, terminal: bool = True, **options: Any) -> Any:
    """The exit code, and the calls of the workflow, where a person answers so."""
    calls: list[tuple[str, ...]] = []
    told = io.StringIO(answer)
    monkeypatch.setattr(told, "isatty", lambda: terminal)
    monkeypatch.setattr("sys.stdin", told)

    def workflow(*arguments: str) -> int:
        calls.append(arguments)
        return 0

    settings = {"cores": 3, "few_trials": False, "yes": False} | options
    return guess_and_run(["My arm.csv"], None, [], workflow, **settings), calls


def test_a_confirmed_guess_is_written_and_run(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, calls = asked(monkeypatch, "y\n")
    assert code == 0
    assert calls == [("--cores", "3", "--config", "datasets=[my_arm]")]
    assert "my_arm:" in (project / "config" / "datasets.yaml").read_text()
    shown = capsys.readouterr()
    assert "Is this entry right?" in shown.err
    assert "softkin predict results/my_arm/calibrated_model.joblib commands.csv --level 0.9" in shown.out
    with pytest.raises(ConfigError, match="softkin run --robot my_arm"):
        asked(monkeypatch, "y\n")


def test_nothing_is_written_where_it_is_not_confirmed(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (project / "config" / "datasets.yaml").read_text()
    for answer in ("n\n", "\n", ""):
        assert asked(monkeypatch, answer) == (2, [])
        assert "nothing is written, as you said no" in capsys.readouterr().err
    assert asked(monkeypatch, "y\n", terminal=False) == (2, [])
    assert "nobody can be asked here\n  fix: look at the entry, then say --yes" in capsys.readouterr().err
    assert (project / "config" / "datasets.yaml").read_text() == before


@pytest.mark.usefixtures("project")
def test_who_says_yes_is_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    code, calls = asked(monkeypatch, "", terminal=False, yes=True, few_trials=True)
    assert code == 0
    assert calls == [("--cores", "3", "--config", "datasets=[my_arm]", "--configfile", "config/few_trials.yaml")]


@pytest.mark.usefixtures("project")
def test_a_workflow_that_fails_is_not_said_to_have_a_model(capsys: pytest.CaptureFixture[str]) -> None:
    settings = {"cores": 1, "few_trials": False, "yes": True}
    assert guess_and_run(["My arm.csv"], None, [], lambda *_: 1, **settings) == 1  # type: ignore[arg-type]
    assert "softkin predict" not in capsys.readouterr().out


def test_a_file_of_no_use_is_not_run(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "My arm.csv").unlink()
    assert asked(monkeypatch, "y\n") == (2, [])
    assert "My arm.csv" in capsys.readouterr().err
