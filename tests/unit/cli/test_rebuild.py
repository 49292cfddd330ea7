from __future__ import annotations

import re
import shutil
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from softkin.cli import rebuild
from softkin.cli.rebuild import FILES, OF_SOME, can_be_rebuilt, rebuilt
from softkin.cli.recompute import recomputed
from softkin.core.errors import ResultError
from softkin.core.files import read_json, write_json
from softkin.core.job_records import record_job
from softkin.models import MODELS
from softkin.reporting.tables.build import build_tables
from softkin.reporting.titles import Titles
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import HOUSE
from tests.unit.reporting.tables.conftest import SOURCES, write_run

CONFIG: dict[str, Any] = {
    "datasets": list(SOURCES),
    "sources": SOURCES,
    "models": ["gb", "lr"],
    "presets": ["paper", "tuned"],
    "objective": "both",
    "caution": "Few trials.",
}
TITLES = Titles(
    {name: spec.title for name, spec in MODELS.items()},
    {name: method.title for name, method in INTERVAL_METHODS.items()},
)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of two datasets as jobs write them, without what the summary is made of."""
    place = tmp_path_factory.mktemp("run")
    (place / "made").mkdir()
    run, folder = write_run(place / "made"), place / "results"
    for dataset, files in run.datasets.items():
        (folder / dataset).mkdir(parents=True)
        for key, path in asdict(files).items():
            (folder / dataset / FILES[key]).write_bytes(Path(path).read_bytes())
        for model in CONFIG["models"]:
            (folder / dataset / model / "tuned").mkdir(parents=True)
            best = folder / dataset / model / "tuned" / "parameters.json"
            best.write_bytes(run.parameters[dataset, model, "tuned"].read_bytes())
    build_tables(run.tables(), titles=TITLES, folder=folder / "tables", caution=CONFIG["caution"])
    write_json(folder / "summary.json", {"configuration": CONFIG})
    searched = {dataset: [["gb", "tuned"], ["lr", "tuned"]] for dataset in SOURCES}
    params = {"searched": searched, "sources": SOURCES, "objective": "both", "caution": CONFIG["caution"]}
    tables = list((folder / "tables").iterdir())
    record_job(folder / "logs" / "build_tables.log", tables, params | {"code": "of another version"})
    return folder


@pytest.fixture
def results(written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy that a test may change."""
    monkeypatch.setattr(rebuild, "_summarise", lambda *_: None)
    monkeypatch.setattr(rebuild, "SUMMARY", Path("summary.json"))
    return shutil.copytree(written, tmp_path / "results")


def test_tables_that_are_as_their_job_made_them_pass(results: Path) -> None:
    """Those of an earlier version too, which have `inf` where there is a word now."""
    for path in (results / "finger" / "interval_metrics.csv", results / "tables" / "interval_metrics.csv"):
        table = pd.read_csv(path)
        of_tip = (table["dataset"] == "finger") & (table["coordinate"] == "m1_x")
        table.loc[of_tip, "mean_width_mm"] = float("inf")
        table.to_csv(path, index=False)
    assert can_be_rebuilt(results)
    assert [sentence for sentence in rebuilt(results) if "interval_tables" not in sentence] == []


def test_each_edited_number_or_word_is_named(results: Path) -> None:
    edits = {
        "claims.csv": ("not assessable", "holds", ", row 1, column verdict: holds stands there"),
        "headline.txt": ("Few trials", "Many trials", ", line 4: 'CAUTION: Many trials.' stands there"),
        "interval_tables.md": ("FINGER", "F1NGER", ", line "),
        "paper_tables.tex": ("FINGER", "F1NGER", ", line "),
        "selection.csv": (",1.0,", ",1.000000001,", ", row 1, column cv_mae_mm"),
    }
    for name, (old, new, _) in edits.items():
        path = results / "tables" / name
        assert old in path.read_text(), name
        path.write_text(path.read_text().replace(old, new, 1))
    (results / "tables" / "alarm_rates.csv").rename(results / "tables" / "rates.csv")
    gone, *found, came = rebuilt(results)
    assert "alarm_rates.csv is not there" in gone
    assert "rates.csv is none of the tables" in came
    for (name, (_, _, says)), sentence in zip(edits.items(), found, strict=True):
        assert f"{name}{says}" in sentence


def test_another_configuration_is_named(results: Path) -> None:
    summary = read_json(results / "summary.json")
    summary["configuration"]["objective"] = "interpolation"
    write_json(results / "summary.json", summary)
    with pytest.raises(ResultError, match="the tables were made with: objective"):
        rebuilt(results)
    assert any("the tables were made with: objective" in sentence for sentence in recomputed(results))


def test_the_job_of_the_tables_reads_the_same_files() -> None:
    rule = (HOUSE / "workflow" / "rules" / "tables.smk").read_text()
    read = set(re.findall(r"results/\{dataset\}/(\w+\.\w+)", rule))
    assert read == {*FILES.values(), *(f"{name}.csv" for name in OF_SOME.values())}
