from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.cli.datasets_file import append_entry, entry_text, read_key
from softkin.core.errors import ConfigError

BEFORE = "# robots\nsources:\n  # the first\n  finger: {title: Finger}\n"
ENTRY: dict[str, Any] = {"title": "Ärm: #1", "commands": ["u1", "u 2"], "split": {"method": "random"}}


def test_an_entry_survives_its_text_and_reasons_are_comments() -> None:
    text = entry_text("arm", ENTRY, ["split: at random", "left out: a\nb"])
    assert yaml.safe_load(text) == {"arm": ENTRY}
    lines = text.splitlines()
    assert lines[:3] == ["  # split: at random", "  # left out: a b", "  arm:"]
    assert "Ärm" in text


def test_an_entry_is_appended_and_all_before_it_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "datasets.yaml"
    path.write_text(BEFORE, encoding="utf-8")
    append_entry(path, "arm", entry_text("arm", ENTRY, []))
    after = path.read_text(encoding="utf-8")
    assert after.startswith(BEFORE)
    assert yaml.safe_load(after)["sources"] == {"finger": {"title": "Finger"}, "arm": ENTRY}


@pytest.mark.parametrize("end", ["", "\n\n\n"])
def test_the_file_may_end_in_any_number_of_empty_lines(tmp_path: Path, end: str) -> None:
    path = tmp_path / "datasets.yaml"
    path.write_text(BEFORE.rstrip("\n") + end)
    append_entry(path, "arm", entry_text("arm", ENTRY, []))
    assert list(yaml.safe_load(path.read_text())["sources"]) == ["finger", "arm"]


@pytest.mark.parametrize(
    ("content", "what"),
    [
        ("sources:\n  arm: {title: A}\n", "there is an entry 'arm' already"),
        ("sources:\n  a: {title: A}\nlast: 1\n", "`sources` is not its last key"),
        ("sources:\n  a: {title: A}\nlast:\n  b: 1\n", "`sources` is not its last key"),
        ("sources:\n    a: {title: A}\n", "not indented by two"),
        ("sources: [\n", "no YAML with the key `sources`"),
        ("sources:\n", "`sources` is no dict"),
        ("", "no YAML with the key `sources`"),
    ],
)
def test_a_file_that_cannot_be_appended_to_is_an_error_and_stays(tmp_path: Path, content: str, what: str) -> None:
    path = tmp_path / "datasets.yaml"
    path.write_text(content)
    with pytest.raises(ConfigError, match=what) as raised:
        append_entry(path, "arm", entry_text("arm", ENTRY, []))
    assert raised.value.where == str(path)
    assert raised.value.fix
    assert path.read_text() == content


def test_a_key_is_read_with_its_type() -> None:
    path = Path("config.yaml")
    assert read_key("datasets: [a, b]\nseed: 0\n", path, "datasets", list) == ["a", "b"]
    with pytest.raises(ConfigError, match="`datasets` is no list"):
        read_key("datasets: a\n", path, "datasets", list)
    with pytest.raises(ConfigError, match="no YAML with the key `datasets`"):
        read_key("seed: 0\n", path, "datasets", list)
