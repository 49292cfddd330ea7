from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli import prune
from softkin.core.files import write_json
from softkin.tracking.nights import NightRecord, log_night, nights
from softkin.tracking.store import client_of
from tests.unit.stores import new_store


@pytest.mark.parametrize(("options", "left", "says"), [([], 3, "would remove: "), (["--yes"], 1, "removed: ")])
def test_it_says_what_goes_and_removes_it_when_told(
    options: list[str], left: int, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    address = new_store(tmp_path / "mlflow.db")
    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": address})
    client = client_of(address)
    for started in (1.0, 2.0, 3.0):
        log_night(client, NightRecord({"outcome": "same", "exit_code": 0}, "A page.", None, None, {}, started))
    assert prune.main(["--keep", "1", *options]) == 0
    assert len(nights(client)) == left
    assert capsys.readouterr().out.count(f"{says}campaign") == 2


def test_keeping_none_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert prune.main(["--keep", "0"]) == 2
    assert "make prune KEEP=50" in capsys.readouterr().err
