"""A run of which some parts fail: it says why, and makes the rest."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from softkin.core.csv_tables import read_csv
from tests.workflow.conftest import NOWHERE, House, copy_house

pytestmark = pytest.mark.timeout(600)


def test_a_dataset_a_model_and_a_method_that_fail_take_the_tables_of_nothing_else(mirror: Path, tmp_path: Path) -> None:
    """One dataset's file is broken, and one model and one interval method raise: the run fails and says why, and tables
    and report are made of the rest.
    """
    broken = tmp_path / "mirror"
    shutil.copytree(mirror, broken)
    (broken / "FINGER.json").write_bytes((broken / "FINGER.json").read_bytes()[:-100])
    copy_house(tmp_path / "house")
    for name in ("models/ridge.py", "uncertainty/intervals/split_conformal_crepes.py"):
        file = tmp_path / "house" / "src" / "softkin" / name
        head, signature, body = file.read_text().partition("def intervals(" if "intervals" in name else "def build(")
        ends = body.index(":\n", body.index(")")) + 2
        file.write_text(f"{head}{signature}{body[:ends]}    raise ArithmeticError\n{body[ends:]}")
    bad = House(tmp_path / "house", tmp_path, broken)
    small = ["models=[lr, ridge]", "presets=[paper]", "interval_methods=[scp_mapie, scp_crepes]", "regions=[]"]
    options = ["--config", *small, f"sources={{finger: {{urls: ['{NOWHERE}']}}}}"]
    model = tmp_path / "results" / "elastica_2023_09" / "calibrated_model.joblib"
    model.parent.mkdir(parents=True)
    model.write_text("of an earlier run")
    done = bad.forked("results/report.html", *options)
    output = done.stdout + done.stderr
    assert done.returncode != 0
    for part in ("dataset 'finger'", "wrong file: sha256 is", "SOFTKIN_DATA_MIRROR"):
        assert part in output
    assert not (tmp_path / "results" / "finger" / "raw").exists()
    said = (tmp_path / "results" / "tables" / "headline.txt").read_text()
    for missing in (
        *("the model ridge on elastica_2023_09 (fit_model ridge failed)", "finger (retrieve failed)"),
        "the interval method scp_crepes on elastica_2023_09 (calibrate failed)",
    ):
        assert missing in " ".join(said.split())
        assert missing in " ".join(output.split())
    table = read_csv(tmp_path / "results" / "tables" / "interval_metrics.csv")
    assert set(table[["dataset", "model", "interval_method"]].itertuples(index=False, name=None)) == {
        ("elastica_2023_09", "lr", "scp_mapie")
    }
    page = (tmp_path / "results" / "report.html").read_text()
    assert "finger (retrieve failed)" in page
    assert "the model ridge" in page
    assert model.read_text() == "of an earlier run"
