"""The recordings in config/examples are understood as labs mean them."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.cli.new_robot import main
from softkin.core.samples import SUBSETS
from softkin.data.audit import swapped_markers
from softkin.data.readers import table_file
from tests.conftest import HOUSE

EXAMPLES = HOUSE / "config" / "examples"
RECORDINGS = EXAMPLES / "recordings"


def understood(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *files: str) -> dict[str, Any]:
    """The entry that is guessed and written for the files of a recording."""
    shutil.copytree(HOUSE / "config", tmp_path / "config")
    monkeypatch.chdir(tmp_path)
    given = [str(Path("config/examples/recordings", file)) for file in files]
    assert main(["--name", "robot", "--write", "--", *given]) == 0
    entry: dict[str, Any] = yaml.safe_load(Path("config/datasets.yaml").read_text())["sources"]["robot"]
    return entry


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        (["two_files/commands.csv", "two_files/take.csv"], {"position_unit": "m", "order": "time_s"}),
        (["sessions.csv"], {"session": "session", "split": {"method": "session"}, "order": "time_s"}),
        (["lag.csv"], {"order": "time_s", "split": {"method": "time", "column": "time_s"}}),
        (["gaps.csv"], {"missing": "drop_rows", "order": "time_s"}),
        (["swapped.csv"], {"order": "time_s", "position_unit": "mm"}),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_a_recording_of_each_shape_is_understood(
    files: list[str], expected: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    entry = understood(tmp_path, monkeypatch, *files)
    assert {key: entry.get(key) for key in expected} == expected
    assert entry["commands"] == ["motor1", "motor2"]
    assert len(entry["positions"]) == 9
    path = Path(entry["file"]) if "file" in entry else None
    if path is None:
        assert entry["join"]["by"] == "time"
        return
    subsets = table_file.read(path, dataset="robot", source=entry)
    assert set(subsets) == set(SUBSETS)
    swapped = swapped_markers.check(subsets).numbers["rows"]
    assert sum(swapped.values()) == (12 if files == ["swapped.csv"] else 0)
