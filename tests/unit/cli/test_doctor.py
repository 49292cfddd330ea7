from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from softkin.cli import doctor
from softkin.cli.doctor import diagnosis, is_well, sentences
from softkin.core.errors import ConfigError
from softkin.core.files import write_json


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with a published robot and one of a person's own; the first has a file in the mirror."""
    mirror = tmp_path / "mirror"
    mirror.mkdir()
    (mirror / "A.json").write_text("{}")
    monkeypatch.setenv("SOFTKIN_DATA_MIRROR", str(mirror))
    (tmp_path / "config").mkdir()
    published = {"file": "A.json", "urls": [], "standin": {"robot": "pneumatic_arm", "seed": 0}}
    sources = {"a": published, "mine": {"file": "mine.csv"}}
    (tmp_path / "config" / "config.yaml").write_text(yaml.safe_dump({"datasets": ["a", "mine"], "data_mirror": None}))
    (tmp_path / "config" / "datasets.yaml").write_text(yaml.safe_dump({"sources": sources}))
    return tmp_path


def test_it_says_what_is_there_and_what_is_not(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = diagnosis(folder)
    assert found["datasets"] == {"a": "can be had", "mine": "its file is not there, out of reach"}
    assert found["store"] is None
    assert found["libraries"]["numpy"]
    assert not is_well(found)
    (folder / "mine.csv").write_text("u,x\n")
    write_json(folder / "results" / "mlflow_store.json", {"tracking_uri": "sqlite:///mlflow.db"})
    well = diagnosis(folder)
    assert is_well(well)
    assert "MLflow store: sqlite:///mlflow.db" in sentences(well)
    monkeypatch.setattr(doctor, "LIBRARIES", ("numpy", "no-such-library"))
    assert "  no-such-library IS MISSING" in sentences(diagnosis(folder))
    (folder / "mirror" / "A.json").unlink()
    assert diagnosis(folder)["datasets"]["a"].startswith("out of reach: ")


def test_elsewhere_it_says_where_to_run_it(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="run it in the folder of softkin"):
        diagnosis(tmp_path)
