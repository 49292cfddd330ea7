"""The workflow is one that GitHub takes, and its steps do what they say under bash."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.campaigns.github_actions import github_workflow

NOTIFY = "printf \"%s\" '@CRON@' ${{ 1 }} # me@example.org"


def made(inside: str = ".", notify: str | None = NOTIFY) -> str:
    variables = {"OMP_NUM_THREADS": "1"}
    return github_workflow("03:07", 3, notify=notify, variables=variables, apprise="apprise==1", inside=inside)


@pytest.mark.parametrize("inside", [".", "robots/Roboter für 100 %", 'a "b": c'])
def test_the_workflow_is_what_its_schema_allows(inside: str, tmp_path: Path) -> None:
    if importlib.util.find_spec("check_jsonschema") is None:
        pytest.skip("check-jsonschema is not installed: make test installs it")
    file = tmp_path / "campaign.yml"
    file.write_text(made(inside))
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_linter_has_nothing_to_say(tmp_path: Path) -> None:
    if shutil.which("actionlint") is None:
        pytest.skip("actionlint is not installed: https://github.com/rhysd/actionlint")
    (tmp_path / "campaign.yml").write_text(made())
    done = subprocess.run(["actionlint", str(tmp_path / "campaign.yml")], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")


def test_it_starts_every_day_and_keeps_what_the_next_night_needs() -> None:
    read = yaml.safe_load(made("robots/arm"))
    assert read[True] == {"schedule": [{"cron": "7 3 * * *"}], "workflow_dispatch": None}  # YAML takes `on` for true
    job = read["jobs"]["campaign"]
    assert job["defaults"]["run"]["working-directory"] == "robots/arm"
    paths = [step["with"]["path"].split() for step in job["steps"] if "cache" in step.get("uses", "")]
    assert paths == [[f"robots/arm/{name}" for name in ("results", ".snakemake", "mlflow.db*", "mlartifacts")]] * 2
    keep = next(step for step in job["steps"] if step.get("uses", "").startswith("actions/cache/save"))
    assert keep["if"] == "always()"
    assert job["env"] == {"OMP_NUM_THREADS": "1", "NOTIFY_URLS": "${{ secrets.NOTIFY_URLS }}"}


def bash(step: dict[str, Any], folder: Path, **environment: str) -> int:
    """Run a step as GitHub does, after its expressions, with these variables alone."""
    script = step["run"].replace("${{ '${{' }}", "${{")
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
    return subprocess.run(command, cwd=folder, env={"PATH": "/usr/bin:/bin", **environment}, check=False).returncode


@pytest.mark.parametrize("code", [0, 1, 3, 4, 75])
def test_the_campaign_is_started_and_its_exit_code_is_that_of_the_job(tmp_path: Path, code: int) -> None:
    (tmp_path / ".venv" / "bin").mkdir(parents=True)
    python = tmp_path / ".venv" / "bin" / "python"
    record = 'printf "%s\\0" "$@" > heard; env > variables; mkdir -p results; echo better > results/verdict.md'
    python.write_text(f"#!/bin/sh\n{record}\nexit {code}\n")
    python.chmod(0o755)
    steps = {step["name"]: step for step in yaml.safe_load(made())["jobs"]["campaign"]["steps"] if "name" in step}
    files = {name: str(tmp_path / name) for name in ("GITHUB_OUTPUT", "GITHUB_STEP_SUMMARY")}
    assert bash(steps["Campaign"], tmp_path, **files) == 0
    words = (tmp_path / "heard").read_text().split("\0")[:-1]
    assert words == ["-m", "softkin.cli.campaign", "--cores", "3", f"--notify={NOTIFY}"]
    assert (tmp_path / "GITHUB_OUTPUT").read_text() == f"exit_code={code}\n"
    assert (tmp_path / "GITHUB_STEP_SUMMARY").read_text() == "better\n"
    last = steps["A verdict that a person looks at fails this job"]
    assert last["env"] == {"EXIT_CODE": "${{ steps.campaign.outputs.exit_code }}"}
    assert bash(last, tmp_path, EXIT_CODE=str(code)) == code
