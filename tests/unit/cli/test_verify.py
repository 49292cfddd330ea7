from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.verify import main, verify
from tests.unit.cli.results import write_results


@pytest.fixture
def results(tmp_path: Path) -> Path:
    write_results(tmp_path / "results")
    return tmp_path / "results"


def test_what_is_as_it_was_written_passes(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--in", str(results.parent)]) == 0
    said = capsys.readouterr().out
    assert "14 files are as they were written" in said
    assert "by their hashes alone" in said
    assert "headline and claims, for want of tables/summary.json" in said


def test_what_is_wrong_is_named_with_what_to_do(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (results / "arm" / "lr" / "paper" / "model.joblib").write_bytes(b"A model")
    table = results / "tables" / "point_metrics.csv"
    table.write_bytes(table.read_bytes()[:-40])
    (results / "arm" / "lr" / "tuned" / "fit.json").unlink()
    (results / "arm" / "swapped.joblib").write_bytes(b"a model")
    (results / "manifest" / "arm" / "score.json").write_text("{")
    assert main(["--in", str(results.parent)]) == 1
    said = capsys.readouterr().out
    for part in (
        "lr/paper/model.joblib was changed since it was written (fit_model arm paper)",
        "tables/point_metrics.csv was changed since it was written (build_tables)",
        "lr/tuned/fit.json is gone (fit_model arm tuned)",
        "swapped.joblib was written by no job that is recorded",
        "manifest/arm/score.json is no record of a job",
        "make run",
    ):
        assert part in said


def test_results_without_records_do_not_pass(tmp_path: Path) -> None:
    (sentence,) = verify(tmp_path / "results")
    assert "no job has recorded what it wrote" in sentence
