"""The command `softkin`: its answers, its exit codes, and that its help loads no numerical library."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import joblib
import pandas as pd
import pytest
from typer.testing import CliRunner, Result

from softkin.cli.main import EXIT_CODES, app
from tests.conftest import bending_arm
from tests.unit.uncertainty.small_robot import small_robot

ROWS = bending_arm(60, seed=3)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A model, and what was recorded of its robot."""
    monkeypatch.chdir(tmp_path)
    joblib.dump(small_robot(), "model.joblib")
    commands = pd.DataFrame(ROWS.commands, columns=["left", "right"])
    commands.to_csv("commands.csv", index=False)
    positions = pd.DataFrame(ROWS.positions, columns=["m1_x", "m1_y", "m1_z"])
    pd.concat([commands, positions], axis=1).to_csv("well.csv", index=False)
    pd.DataFrame(small_robot().predict(ROWS.commands[:2] / 2), columns=positions.columns).to_csv(
        "inside.csv", index=False
    )
    (positions[:2] + 50.0).to_csv("far.csv", index=False)
    pd.concat([commands, positions + 3.0], axis=1).to_csv("moved.csv", index=False)
    return tmp_path


def asked(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


def test_predictions_in_each_form(folder: Path) -> None:
    done = asked("predict", "model.joblib", "commands.csv", "--trust", "--to", "poses.csv")
    assert (done.exit_code, done.stdout) == (0, "")
    table = pd.read_csv(folder / "poses.csv")
    assert len(table) == 60
    assert asked("predict", "model.joblib", "commands.csv", "--trust", "--out", "parquet", "--to", "p").exit_code == 0
    pd.testing.assert_frame_equal(pd.read_parquet("p"), table)
    for form in (["--json"], ["--out", "json"]):
        written = json.loads(asked("predict", "model.joblib", "commands.csv", "--trust", *form).stdout)
        assert written[5]["m1_x"] == table["m1_x"][5]
        assert written[5]["outside"] is False


def test_a_model_is_exported_in_each_form(folder: Path) -> None:
    done = asked("export", "model.joblib", "--trust", "--to", "out", "--level", "0.9")
    assert (done.exit_code, done.stdout.split()) == (0, ["out/arm.py", "out/arm.h"])
    assert (folder / "out" / "arm.h").is_file()
    done = asked("export", "model.joblib", "--trust", "--form", "c", "--name", "left", "--json")
    assert json.loads(done.stdout) == ["left.h"]


def test_commands_for_targets_say_what_is_out_of_reach(folder: Path) -> None:
    """What comes out is what `predict` takes, and it goes where it says."""
    done = asked("inverse", "model.joblib", "far.csv", "--trust", "--tolerance", "2", "--to", "far_commands.csv")
    assert (done.exit_code, done.stdout, done.stderr) == (3, "", "")
    far = pd.read_csv("far_commands.csv")
    assert (far["verdict"] != "reachable").all()
    assert (far["probability"] == 0).all()
    assert asked("predict", "model.joblib", "far_commands.csv", "--trust", "--to", "again.csv").exit_code == 0
    pd.testing.assert_series_equal(pd.read_csv(folder / "again.csv")["m1_x"], far["m1_x"])
    pd.read_csv("again.csv")[["m1_x", "m1_y", "m1_z", "outside"]].to_csv("reached.csv", index=False)
    done = asked("inverse", "model.joblib", "reached.csv", "--trust", "--path", "--marker", "0", "--out", "json")
    assert done.stderr == "softkin: not read: outside\n"
    assert done.exit_code == (0 if all(row["verdict"] == "reachable" for row in json.loads(done.stdout)) else 3)
    assert json.loads(done.stdout)[1]["left"] == pytest.approx(far["left"][1], abs=1e-3)
    inside = asked("inverse", "model.joblib", "inside.csv", "--trust", "--confidence", "0.8")
    assert inside.exit_code == 0
    assert inside.stdout.startswith("left,right,m1_x,lower_m1_x,upper_m1_x,")


def test_commands_worth_measuring_are_what_predict_takes(folder: Path) -> None:
    done = asked("suggest", "model.joblib", "--trust", "--rows", "5", "--to", "next.csv")
    assert (done.exit_code, done.stdout, done.stderr) == (0, "", "")
    table = pd.read_csv(folder / "next.csv")
    assert list(table) == ["left", "right", "distance", "width_mm", "outside"]
    assert len(table) == 5
    assert asked("predict", "model.joblib", "next.csv", "--trust").exit_code == 0
    written = json.loads(asked("suggest", "model.joblib", "--trust", "--rows", "2", "--inside", "--out", "json").stdout)
    assert [row["outside"] for row in written] == [False, False]
    assert asked("suggest", "model.joblib", "--trust", "--rows", "5", "--out", "parquet", "--to", "p").exit_code == 0
    pd.testing.assert_frame_equal(pd.read_parquet("p"), table)
    assert asked("suggest", "model.joblib", "--trust", "--rows", "5", "--seed", "1").stdout != table.to_csv(index=False)


@pytest.mark.parametrize(("recording", "code"), [("well.csv", 0), ("moved.csv", 3)])
def test_the_exit_code_says_whether_the_robot_is_where_it_should_be(folder: Path, recording: str, code: int) -> None:
    del folder
    done = asked("check", "model.joblib", recording, "--trust")
    assert done.exit_code == code
    assert ("ALARM" in done.stdout) == (code == 3)
    found = json.loads(asked("check", "model.joblib", recording, "--trust", "--json").stdout)
    assert (found["alarm_pose"] is not None) == (code == 3)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["predict", "model.joblib", "commands.csv"], "pass the sha256"),
        (["predict", "model.joblib", "commands.csv", "--trust", "--level", "90"], "write it as 0.9"),
        (["predict", "model.joblib", "none.csv", "--trust"], "no such file"),
        (["predict", "none.joblib", "commands.csv"], "no such file"),
        (["check", "model.joblib", "commands.csv", "--trust"], "missing 'tip x'"),
        (["check", "model.joblib", "well.csv", "--trust", "--rate", "2"], "no rate of false alarms"),
        (["export", "model.joblib", "--trust", "--level", "90"], "write it as 0.9"),
        (["export", "none.joblib"], "no such file"),
        (["inverse", "model.joblib", "none.csv", "--trust"], "no such file"),
        (["inverse", "model.joblib", "commands.csv", "--trust"], "missing 'tip x'"),
        (["inverse", "model.joblib", "far.csv", "--trust", "--marker", "3"], "3 is no marker of this robot"),
        (["inverse", "model.joblib", "far.csv", "--trust", "--confidence", "90"], "write it as 0.9"),
        (["suggest", "model.joblib", "--trust", "--rows", "0"], "0 is no number of rows"),
        (["suggest", "model.joblib", "--trust", "--level", "90"], "write it as 0.9"),
        (["suggest", "none.joblib"], "no such file"),
        (["doctor"], "run it in the folder of softkin"),
    ],
)
def test_a_wrong_call_is_a_sentence_and_exit_code_2(folder: Path, arguments: list[str], says: str) -> None:
    del folder
    done = asked(*arguments)
    assert done.exit_code == 2
    assert says in done.stderr
    assert done.stdout == ""


def test_help_has_examples_and_exit_codes_and_loads_no_numerical_library() -> None:
    code = "import sys; sys.argv[1:] = ['--help']\nfrom softkin.cli.main import main\n"
    code += "try: main()\nexcept SystemExit: pass\n"
    code += "print(*{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numpy", "pandas", "sklearn", "scipy", "mlflow", "snakemake"} & set(
        done.stdout.splitlines()[-1].split()
    )
    assert " ".join(EXIT_CODES.split()) in " ".join(done.stdout.split())
    for name in (
        "run",
        "demo",
        "new-robot",
        "predict",
        "check",
        "export",
        "inverse",
        "suggest",
        "ui",
        "campaign",
        "verify",
        "prune",
        "schedule",
        "doctor",
    ):
        assert f"\n  {name} " in done.stdout
