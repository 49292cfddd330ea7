from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from softkin.campaigns.crate import METADATA, PROFILES, RUN, write_crate
from softkin.core.files import read_json
from softkin.core.job_records import record_job
from tests.conftest import HOUSE


@pytest.fixture
def crate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The results of a run of two jobs, described."""
    monkeypatch.chdir(tmp_path)
    raw, table = Path("results/finger/raw"), Path("results/tables/point metrics.csv")
    for path in (raw, table):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{path}\n")
    record_job("results/logs/retrieve/finger.log", [raw])
    record_job("results/logs/build_tables.log", [table])
    write_crate(Path("results"), workflow=HOUSE / "Snakefile", title="softkin nights", started=0.0, ended=90.0)
    return tmp_path / "results"


def entities(crate: Path) -> dict[str, dict[str, Any]]:
    return {entity["@id"]: entity for entity in read_json(crate / METADATA)["@graph"]}


def test_every_file_is_there_with_its_hash_and_size(crate: Path) -> None:
    found = entities(crate)
    table = found["tables/point%20metrics.csv"]
    assert table["contentSize"] == str((crate / "tables" / "point metrics.csv").stat().st_size)
    assert len(table["sha256"]) == 64
    assert table["encodingFormat"] == "text/csv"
    parts = {part["@id"] for part in found["./"]["hasPart"]}
    assert parts == {"Snakefile", "finger/raw", "tables/point%20metrics.csv"}
    assert (crate / "Snakefile").read_text() == (HOUSE / "Snakefile").read_text()


def test_the_run_goes_from_what_was_retrieved_to_what_was_made(crate: Path) -> None:
    action = entities(crate)[RUN]
    assert action["object"] == [{"@id": "finger/raw"}]
    assert action["result"] == [{"@id": "tables/point%20metrics.csv"}]
    assert action["instrument"] == {"@id": "Snakefile"}
    assert (action["startTime"], action["endTime"]) == ("1970-01-01T00:00:00+00:00", "1970-01-01T00:01:30+00:00")


def test_all_that_is_referred_to_is_described(crate: Path) -> None:
    """But for identifiers and pages elsewhere."""
    found = entities(crate)
    assert {name["@id"] for name in found["./"]["conformsTo"]} == set(PROFILES)
    text = json.dumps(list(found.values()))
    for name in (*PROFILES, "Snakefile", RUN, found["Snakefile"]["programmingLanguage"]["@id"]):
        assert name in found
        assert json.dumps({"@id": name}) in text


def validator() -> Path | None:
    """The interpreter that has roc-validator: `make campaigns` gives it an environment of its own."""
    own = Path(sys.prefix) / "roc-validator" / "bin"
    program = shutil.which("rocrate-validator", path=os.pathsep.join([str(own), os.environ.get("PATH", "")]))
    return Path(program).with_name("python") if program else None


@pytest.mark.slow
def test_the_validator_accepts_it_and_nothing_that_lacks_a_file(crate: Path) -> None:
    python = validator()
    if python is None:
        pytest.skip("roc-validator is not installed: make campaigns installs it")
    command = [str(python), str(HOUSE / "tests" / "unit" / "campaigns" / "validate_crate.py"), str(crate)]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, len(done.stdout.splitlines())) == (0, 1), done.stdout + done.stderr
    (crate / "tables" / "point metrics.csv").unlink()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "does not include the Data Entity 'tables/point%20metrics.csv'" in done.stdout
