from __future__ import annotations

from pathlib import Path
from typing import Any

from softkin.core.files import write_json
from softkin.core.samples import SUBSETS
from softkin.data.reachability import out_of_reach, stand_in_entry, warning, with_stand_ins
from softkin.data.readers import READERS

ROWS = {"train": 20, "validation": 4, "test": 4, "extrapolation": 8}
ENTRY: dict[str, Any] = {
    "title": "FINGER (real tendon finger)",
    "format": "kinn_json",
    "file": "FINGER.json",
    "sha256": "ab" * 32,
    "position_unit": "m",
    "n_commands": 2,
    "n_markers": 1,
    "paper_table": 5,
    "rows": ROWS,
    "standin": {"robot": "tendon_finger", "seed": 7},
}


def test_an_unreachable_dataset_is_replaced_under_a_name_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "retrieved").touch()
    sources = {name: ENTRY | {"urls": []} for name in ("finger", "before", "elsewhere")}
    sources["plain"] = {key: value for key, value in ENTRY.items() if key != "standin"} | {"urls": []}
    retrieved = {name: tmp_path / ("retrieved" if name == "before" else "no") for name in sources}
    wanted = ["finger", "before", "plain"]
    assert list(out_of_reach(wanted, sources, mirror=None, retrieved=retrieved)) == ["finger"]
    missing = out_of_reach(wanted, sources, mirror=str(tmp_path), retrieved=retrieved)
    assert missing == {"finger": [f"mirror {tmp_path / 'FINGER.json'}: no such file"]}
    names, entries = with_stand_ins(wanted, sources, ["finger"])
    assert names == ["finger_standin", "before", "plain"]
    assert set(entries) == {*sources, "finger_standin"}
    assert sources["finger"]["title"] == ENTRY["title"]
    (tmp_path / "FINGER.json").write_text("{}")
    assert out_of_reach(wanted, sources, mirror=str(tmp_path), retrieved=retrieved) == {}
    assert with_stand_ins(wanted, sources, []) == (wanted, sources)


def test_a_stand_in_says_what_it_is_and_keeps_nothing_of_the_paper() -> None:
    entry = stand_in_entry(ENTRY | {"urls": [], "notes": {"test": "printed"}})
    assert "STAND-IN" in entry["title"]
    assert not {"urls", "sha256", "paper_table", "notes", "standin"} & set(entry)
    text = warning({"finger": ["https://a.org: timed out"]})
    for part in (
        "finger: https://a.org: timed out",
        "not the published data",
        "SOFTKIN_DATA_MIRROR",
        "<name>_standin",
    ):
        assert part in text


def test_its_recipe_is_simulated_when_it_is_read(tmp_path: Path) -> None:
    entry = stand_in_entry(ENTRY)
    write_json(tmp_path / "raw", {key: entry[key] for key in ("robot", "seed", "rows")})
    samples = READERS[entry["format"]](tmp_path / "raw", dataset="finger_standin", source=entry)
    assert {subset: len(samples[subset]) for subset in SUBSETS} == ROWS
    assert samples["train"].positions.shape == (20, 3)
