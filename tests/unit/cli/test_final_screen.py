"""The last lines of a run: what it did, and where what it made is."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest
from snakemake.common import NOTHING_TO_BE_DONE_MSG

from softkin.cli.final_screen import AtMessage, final_screen
from softkin.core.files import write_json

ALL = {"results/report.html", "results/tables/headline.txt", "results/tables/paper_tables.md"}
ALL |= {"results/arm/calibrated_model.joblib", "results/arm/mlflow_runs.json", "results/arm/table.parquet"}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "results" / "tables").mkdir(parents=True)
    (tmp_path / "results" / "tables" / "headline.txt").write_text("THE HEADLINE\n")
    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": "sqlite:///mlflow.db"})
    write_json(tmp_path / "results" / "arm" / "mlflow_runs.json", {"link": "/#/experiments/7/runs?a"})
    return tmp_path


def words(*arguments: object, **named: object) -> str:
    return " ".join(final_screen(*arguments, **named).split())  # type: ignore[arg-type]


def test_it_says_what_was_done_and_where_everything_is(folder: Path) -> None:
    text = final_screen(Path(), ALL, ["arm", "other"], jobs=(3, 3), folder=folder)
    assert text.index("3 jobs done.") < text.index("THE HEADLINE") < text.index("results/report.html")
    assert "results/arm/calibrated_model.joblib  the calibrated model of arm" in text
    assert "other" not in text  # whose model this run was not asked for
    assert "make ui  " in text
    assert text.rstrip().endswith("\n    arm  http://127.0.0.1:5000/#/experiments/7/runs?a")


def test_links_are_those_of_a_server_without_its_credentials(folder: Path) -> None:
    write_json(folder / "results" / "mlflow_store.json", {"tracking_uri": "https://***@example.org/mlflow"})
    text = final_screen(Path(), ALL, ["arm"], jobs=(3, 3), folder=folder)
    assert "arm  https://example.org/mlflow/#/experiments/7/runs?a\n" in text


def test_results_of_an_earlier_version_have_no_link(folder: Path) -> None:
    write_json(folder / "results" / "arm" / "mlflow_runs.json", {"runs": {}})
    text = final_screen(Path(), ALL, ["arm"], jobs=(0, 3), folder=folder)
    assert text.rstrip().endswith("browse every run in the MLflow UI")


def test_paths_are_those_of_the_folder_of_the_run(folder: Path) -> None:
    text = final_screen(Path("results/test run"), ALL, ["arm"], jobs=(1, 3), folder=folder)
    paths = [line.split("  ")[1] for line in text.splitlines() if line.startswith("  ") and line[2] != " "]
    assert paths[-1] == "make ui IN='results/test run'"
    assert {path.startswith("results/test run/results/") for path in paths[:-1]} == {True}
    assert "1 job done, 2 up to date." in text


def test_a_run_that_did_nothing_says_so_first(folder: Path) -> None:
    text = words(Path(), ALL, ["arm"], jobs=(0, 9), folder=folder)
    assert text.startswith("softkin: nothing was to be done")
    assert "THE HEADLINE" in text
    assert "9" not in text


def test_a_run_for_a_single_file_claims_nothing_else(folder: Path) -> None:
    """A headline of an earlier run is there."""
    text = words(Path(), {"results/arm/table.parquet"}, ["arm"], jobs=(2, 2), folder=folder)
    assert text == "softkin: 2 jobs done."


def test_a_message_calls() -> None:
    called: list[int] = []
    logger = logging.Logger("of the test")
    logger.addHandler(AtMessage(NOTHING_TO_BE_DONE_MSG, lambda: called.append(1)))
    logger.info("Building DAG of jobs...")
    assert called == []
    logger.info(NOTHING_TO_BE_DONE_MSG)
    assert called == [1]
