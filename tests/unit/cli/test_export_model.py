from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.export_model import FORMS, remarks, written
from softkin.core.errors import ConfigError
from tests.exported_robots import small
from tests.unit.uncertainty.test_orientations import oriented_robot


def test_a_file_for_each_form(tmp_path: Path) -> None:
    files = written(small("ridge"), tmp_path / "robot", ["python", "c"], [0.9], "my arm")
    assert [path.name for path in files] == ["my_arm.py", "my_arm.h"]
    assert "from my_arm import model" in files[0].read_text()
    assert "static const double my_arm_levels[1] = {0.9};" in files[1].read_text()


def test_an_orientation_is_said_to_stay() -> None:
    assert remarks(small("ridge")) == []
    assert "orientation of the tip stays" in remarks(oriented_robot())[0]


def test_nothing_is_written_where_something_cannot_be(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="write it as"):
        written(small("ridge"), tmp_path, ["python"], [90], None)
    assert not list(tmp_path.iterdir())


def test_bytes_are_written_as_they_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert set(FORMS) == {"python", "c", "onnx"}
    monkeypatch.setitem(FORMS, "onnx", (".onnx", lambda *_: b"\x00\xff"))
    (path,) = written(small("ridge"), tmp_path, ["onnx"], None, "arm")
    assert (path.name, path.read_bytes()) == ("arm.onnx", b"\x00\xff")
