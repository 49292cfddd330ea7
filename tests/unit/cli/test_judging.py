"""Three nights on made-up results, in a real MLflow store."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.campaigns.summary import FORMAT
from softkin.cli.judging import Results, judge_results, log_failure
from softkin.cli.workflow_process import Ended
from softkin.core.files import write_json
from softkin.tracking.nights import nights
from softkin.tracking.promotion import CHAMPION, aliases_of, nominate
from softkin.tracking.store import client_of
from tests.unit.stores import new_store

NAME = "softkin-arm"
#: Nights, one after the other; seconds since the epoch.
STARTED = count(1000)


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> str:
    return new_store(tmp_path_factory.mktemp("store") / "mlflow.db")


@pytest.fixture
def folder(tmp_path: Path, store: str) -> Path:
    results = tmp_path / "results"
    (results / "tables" / "figures").mkdir(parents=True)
    write_json(results / "mlflow_store.json", {"tracking_uri": store})
    for name in ("report.html", "tables/headline.txt", "tables/point_metrics.csv", "tables/figures/published.png"):
        (results / name).write_text("made")
    return results


def results(
    folder: Path, campaign: str, *, factor: float = 1.0, jobs: int = 3, dataset: str = "arm", **more: Any
) -> Results:
    """Results of a night whose errors are `factor` times those of the first."""
    errors = factor * np.random.default_rng(0).exponential(size=60)
    rows = pd.DataFrame({"dataset": dataset, "subset": "test", "row": [f"r{i}" for i in range(60)], "error_mm": errors})
    rows.assign(command=rows["row"], width_mm=2.0, covered="11").to_parquet(folder / "tables" / "summary_rows.parquet")
    data = {
        "title": "Arm",
        "origin": "own",
        "sha256": "ab",
        "rows": {"validation": 50},
        "n_commands": 2,
        "findings": [],
    }
    data |= {"n_markers": 1, "constant_coordinates": [], "unit_in_file": "mm", "content_sha256": {"test": "c"}}
    data |= {"deployed": {"model": "gp", "preset": "tuned", "interval_method": "cps", "outside": "auto"}}
    data |= {"metrics": {"test/rmse_mm": factor}}
    summary = {
        "format": more.pop("format", FORMAT),
        "campaign": campaign,
        "seed": 0,
        "confidence_level": 0.9,
        "configuration_sha256": "a",
        "datasets": {dataset: data},
    }
    summary["configuration"] = {"verdict": {"resamples": 999}, **more}
    write_json(folder / "tables" / "summary.json", summary)
    return Results(folder, next(STARTED), Ended(0, "", 1.0, jobs, 9 - jobs))


def test_three_nights_and_a_gate(folder: Path, store: str) -> None:
    """The first, one that is worse, and one that is as bad: the champion of the first night stays."""
    client: Any = client_of(store)
    client.create_registered_model(NAME)

    def night(factor: float) -> str:
        nominate(client, NAME, str(client.create_model_version(NAME, f"file:///{factor}").version))
        return judge_results(results(folder, "gate", factor=factor), refit=False).outcome

    assert night(1.0) == "first"
    assert aliases_of(client, NAME)[CHAMPION] == "1"
    assert night(1.2) == "worse"
    assert aliases_of(client, NAME)[CHAMPION] == "1"
    assert night(1.2001) == "same"
    assert aliases_of(client, NAME) == {"champion": "1", "candidate": "3"}
    assert night(1.0) == "better"
    assert aliases_of(client, NAME)[CHAMPION] == "4"
    assert "nothing is worse than with version 1" in client.get_model_version(NAME, "4").tags["promoted_because"]


def test_where_nothing_can_be_compared_the_newest_model_is_champion_and_says_so(folder: Path, store: str) -> None:
    """Before the first campaign, and where the one before has a summary of another format."""
    client: Any = client_of(store)
    client.create_registered_model("softkin-leg")

    def nominated() -> str:
        version = str(client.create_model_version("softkin-leg", "file:///leg").version)
        nominate(client, "softkin-leg", version)
        return version

    nominated()
    for number in (FORMAT, FORMAT + 1):
        version = nominated()
        verdict = judge_results(results(folder, "leg", dataset="leg", format=number), refit=False)
        assert verdict.outcome == "first"
        assert aliases_of(client, "softkin-leg")[CHAMPION] == version
        reason = client.get_model_version("softkin-leg", version).tags["promoted_because"]
        assert reason == f"no campaign has numbers of version {int(version) - 1} that it could be compared with"


def test_a_person_may_keep_the_gate(folder: Path, store: str) -> None:
    client: Any = client_of(store)
    judge_results(results(folder, "manual", promote="manual"), refit=False)
    verdict = judge_results(results(folder, "manual", factor=0.5, promote="manual"), refit=False)
    assert verdict.outcome == "better"
    assert verdict.facts["promoted"] == "none"
    assert all(run.data.tags["promoted"] == "none" for run in nights(client) if run.data.tags["campaign"] == "manual")


def test_an_unchanged_night_is_linked_and_not_copied(folder: Path, store: str) -> None:
    judge_results(results(folder, "unchanged"), refit=False)
    assert judge_results(results(folder, "unchanged", jobs=0), refit=False).outcome == "unchanged"
    client: Any = client_of(store)
    other, first = [run for run in nights(client) if run.data.tags["campaign"] == "unchanged"][:2]
    first, other = sorted((first, other), key=lambda run: "same_results_as" in run.data.tags)
    assert other.data.tags["same_results_as"] == first.info.run_id
    assert "report.html" in {file.path for file in client.list_artifacts(first.info.run_id)}
    assert "report.html" not in {file.path for file in client.list_artifacts(other.info.run_id)}


@pytest.mark.parametrize(("factor", "outcome"), [(1.0, "same"), (1.001, "failed")])
def test_what_is_redone_must_come_out_the_same(folder: Path, factor: float, outcome: str) -> None:
    """However small a difference is: nothing explains it."""
    name = f"refit-{factor}"
    judge_results(results(folder, name), refit=False)
    verdict = judge_results(results(folder, name, factor=factor), refit=True)
    assert verdict.outcome == outcome
    assert ("test/rmse_mm is 1.001, before 1.0" in " ".join(verdict.reasons)) is (outcome == "failed")


def test_a_failure_is_logged_with_its_reason(folder: Path, store: str) -> None:
    made = results(folder, "failing")
    verdict = log_failure(made, ["prepare/arm: column u1 is missing"])
    assert verdict.exit_code == 1
    client: Any = client_of(store)
    (run,) = [run for run in nights(client) if run.data.tags["campaign"] == "failing"]
    assert run.info.status == "FAILED"
    assert "column u1 is missing" in run.data.tags["mlflow.note.content"]
