"""The registered model in an environment that has nothing but its own requirements, asked from another folder."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import joblib
import mlflow.pyfunc
import numpy as np
import pytest

from softkin.tracking.champion import log_champion
from softkin.tracking.store import Campaign
from tests.conftest import bending_arm
from tests.exported_robots import ROBOTS
from tests.unit.tracking.robots import champion_files, robot

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]
COMMANDS = bending_arm(20, seed=9).commands
LEVEL = 0.8
#: Another process may add in another order: 2e-13 mm were seen.
SAME_MM = 1e-10
#: Loads the registered model, asks it, and then models of every other kind that its code can hold.
ASKS = """
import json, sys
import joblib, mlflow.pyfunc, numpy, pandas
level, commands = float(sys.argv[1]), numpy.array(json.load(open("commands.json")))
served = mlflow.pyfunc.load_model("models:/softkin-finger@champion")
table = served.predict(pandas.DataFrame(commands, columns=["u1", "u2"]), params={"confidence_level": level})
import softkin
answers = {"code": softkin.__file__, "served": {name: table[name].tolist() for name in table}, "others": {}}
for name in sys.argv[2:]:
    model = joblib.load(name)
    answers["others"][name] = [model.predict(commands).tolist(), model.intervals(commands, level).tolist()]
json.dump(answers, open("answers.json", "w"))
"""


def test_its_requirements_are_all_that_it_needs(
    campaign: Campaign, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MLFLOW_TRACKING_URI", campaign.tracking_uri)
    log_champion(campaign, **champion_files(tmp_path))
    requirements = mlflow.pyfunc.get_model_dependencies("models:/softkin-finger@champion", format="pip")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "commands.json").write_text(json.dumps(COMMANDS.tolist()))
    for name, made in ROBOTS.items():
        joblib.dump(made(), elsewhere / f"{name}.joblib")
    # Nothing of this environment, but what pip reads: where its packages come from.
    bare = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV", "COV"))}
    python = tmp_path / "bare" / "bin" / "python"
    names = [f"{name}.joblib" for name in ROBOTS]
    for line in (
        [sys.executable, "-m", "venv", str(tmp_path / "bare")],
        [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", requirements],
        [str(python), "-c", ASKS, str(LEVEL), *names],
    ):
        done = subprocess.run(line, cwd=elsewhere, env=bare, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[-3000:]
    _check(json.loads((elsewhere / "answers.json").read_text()))


def _check(answers: dict[str, Any]) -> None:
    """They are those of the models here, made by the code that was registered."""
    assert answers["code"].endswith("/code/softkin/__init__.py")
    bounds, joint = robot().intervals(COMMANDS, LEVEL), robot().joint_intervals(COMMANDS, LEVEL).bounds
    expected = {"y_pred": robot().predict(COMMANDS)}
    expected |= {f"{joined}{side}": np.asarray(of)[..., place] for joined, of in (("", bounds), ("joint_", joint))
                 for place, side in enumerate(("lower", "upper"))}  # fmt: skip
    for part, values in expected.items():
        told = np.column_stack([answers["served"][f"{part}_m1_{axis}"] for axis in "xyz"])
        np.testing.assert_allclose(told, values, rtol=0, atol=SAME_MM)
    for name, made in ROBOTS.items():
        positions, intervals = answers["others"][f"{name}.joblib"]
        np.testing.assert_allclose(positions, made().predict(COMMANDS), rtol=0, atol=SAME_MM)
        np.testing.assert_allclose(intervals, made().intervals(COMMANDS, LEVEL), rtol=0, atol=SAME_MM)
