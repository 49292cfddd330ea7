"""Order and session of rows: checked, joined, described."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml

from softkin.core.errors import DataError
from softkin.core.recording import CommandMemory, Recording
from softkin.core.samples import SUBSETS, Samples
from softkin.data.prepare import prepare
from softkin.data.readers import published_json, table_file
from softkin.data.recordings import description, recording_of, with_order_table
from softkin.data.scored_rows import KeptRows
from softkin.data.standins.simulating import simulate
from softkin.data.table import content_hash, read_subset
from tests.conftest import HOUSE, four_subsets

COMMANDS = np.arange(6.0)[:, None]
SOURCE = {"order": {"file": "when.csv", "column": "episode"}, "session": "session"}


def place(row: int) -> str:
    return f"line {row}"


def test_whole_numbers_stay_and_times_become_ranks() -> None:
    assert recording_of(COMMANDS, np.array([7, 3, 9, 1, 2, 4]), None, place).order.tolist() == [7, 3, 9, 1, 2, 4]
    times = np.array([0.5, 0.1, 2.5, 1.5, 9.0, 3.0])
    assert recording_of(COMMANDS, times, None, place).order.tolist() == [2, 1, 4, 3, 6, 5]
    dates = np.array([f"2024-05-0{day}" for day in (2, 1, 4, 3, 6, 5)], dtype=object)
    assert recording_of(COMMANDS, dates, None, place).order.tolist() == [2, 1, 4, 3, 6, 5]


def test_sessions_are_numbered_in_time() -> None:
    found = recording_of(COMMANDS, np.array([5, 6, 1, 2, 3, 4]), np.array(list("bbaaac"), dtype=object), place)
    assert found.session.tolist() == [3, 3, 1, 1, 1, 2]


def test_an_order_may_start_again_in_each_session() -> None:
    found = recording_of(COMMANDS, np.array([2, 1, 3, 1, 2, 3]), np.array([7, 7, 7, 4, 4, 4]), place)
    assert found.session.tolist() == [1, 1, 1, 2, 2, 2]
    assert found.order.tolist() == [2, 1, 3, 4, 5, 6]


def test_a_row_without_order_is_a_hole_in_any_kind_of_file() -> None:
    for hole in ("", None):
        order = np.array(["1", "2", hole, "4", "5", "6"], dtype=object)
        assert recording_of(COMMANDS, order, None, place).session.tolist() == [1, 1, 0, 1, 1, 1]


def test_what_is_no_recording_is_an_error() -> None:
    with pytest.raises(DataError, match=r"line 4, `order`: the same order as line 1: 3"):
        recording_of(COMMANDS, np.array([7, 3, 9, 1, 3, 4]), None, place)
    with pytest.raises(DataError, match=r"line 4, `session`.*stand between"):
        recording_of(COMMANDS, None, np.array([1, 1, 2, 2, 1, 1]), place)


@pytest.mark.parametrize("missing", ["refuse", "drop_rows"])
@pytest.mark.parametrize("column", ["t", "trial"])
def test_a_row_that_is_kept_has_its_order_and_session(tmp_path: Path, missing: str, column: str) -> None:
    rows: list[dict[str, float | None]] = [
        {"t": n, "trial": 1 + n // 30, "u": n % 7 / 7, "x": n, "y": n**2 % 11, "z": 1} for n in range(60)
    ]
    rows[5] |= {column: None}
    (tmp_path / "arm.json").write_text(json.dumps(rows), encoding="utf-8")
    entry = {"commands": ["u"], "positions": ["x", "y", "z"], "split": {"method": "later"}, "position_unit": "mm"}
    source = {**entry, "file": "arm.json", "order": "t", "session": "trial", "missing": missing}
    with pytest.raises(DataError, match=r"row 5 .*`order`, `session`: no order or no session"):
        table_file.read(tmp_path / "arm.json", dataset="arm", source=source)


def order_table(samples: dict[str, Samples]) -> pd.DataFrame:
    rows = [(subset, row) for subset, part in samples.items() for row in range(len(part))]
    frame = pd.DataFrame(rows, columns=["subset", "row"])
    episode = np.random.default_rng(0).permutation(len(frame)) + 1
    return frame.assign(episode=episode, session=1 + (episode > 60))


def test_a_table_beside_the_file_is_joined_row_by_row(tmp_path: Path) -> None:
    samples = four_subsets(dict.fromkeys(SUBSETS, 30))
    frame = order_table(samples)
    frame.sample(frac=1, random_state=1).to_csv(tmp_path / "when.csv", index=False)
    joined = with_order_table(samples, tmp_path / "when.csv", SOURCE)
    commands = np.concatenate([joined[subset].commands for subset in SUBSETS])
    known = [joined[subset].recording for subset in SUBSETS]
    order, session = (np.concatenate([getattr(r, name) for r in known]) for name in ("order", "session"))
    assert order.tolist() == frame["episode"].tolist()
    assert session.tolist() == frame["session"].tolist()
    previous = np.concatenate([r.memory[:, :2] for r in known if r is not None])
    in_time = np.argsort(order)
    later = in_time[1:][np.diff(session[in_time]) == 0]
    before = in_time[:-1][np.diff(session[in_time]) == 0]
    np.testing.assert_array_equal(previous[later], commands[before])
    assert description(joined) == {"rows_of_session": {"1": 60, "2": 60}, "missing_poses": 0}
    assert description(samples) is None
    assert content_hash(joined["train"]) != content_hash(samples["train"])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda frame: frame.iloc[1:], "119 rows that are not the 120"),
        (lambda frame: frame.assign(row=0), "120 rows that are not the 120 of the dataset, each once"),
        (lambda frame: frame.rename(columns={"episode": "number"}), "no column 'episode'"),
        (lambda frame: frame.assign(episode=3), "subset train, row 1, `order`: the same order"),
        (lambda frame: frame.assign(episode=frame["episode"].replace(2, np.nan)), "`session`: no order or no session"),
    ],
)
def test_another_table_is_an_error(tmp_path: Path, change: Any, says: str) -> None:
    samples = four_subsets(dict.fromkeys(SUBSETS, 30))
    change(order_table(samples)).to_csv(tmp_path / "when.csv", index=False)
    with pytest.raises(DataError, match=says):
        with_order_table(samples, tmp_path / "when.csv", SOURCE)


def test_gaps_are_said(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    samples = four_subsets(dict.fromkeys(SUBSETS, 30))
    frame = order_table(samples)
    frame["episode"] += 3 * (frame["episode"] > 40)
    frame.to_csv(tmp_path / "when.csv", index=False)
    with caplog.at_level(logging.WARNING, logger="softkin"):
        found = description(with_order_table(samples, tmp_path / "when.csv", SOURCE))
    assert found is not None
    assert found["missing_poses"] == 3
    assert "3 poses are missing" in caplog.text


def test_columns_of_a_robots_own_table(tmp_path: Path) -> None:
    rows = four_subsets(dict.fromkeys(SUBSETS, 60))
    frame = pd.concat(
        [pd.DataFrame(np.hstack([r.commands, r.positions]), columns=["u1", "u2", "x", "y", "z"]) for r in rows.values()]
    )
    frame = frame.assign(when=np.arange(240)[::-1] / 10, day=["late"] * 100 + ["early"] * 140)
    frame.to_csv(tmp_path / "arm.csv", index=False)
    entry = {"file": "arm.csv", "commands": ["u1", "u2"], "positions": ["x", "y", "z"], "position_unit": "mm"}
    entry |= {"order": "when", "session": "day"}
    subsets = ("train", "validation", "test")

    def recordings(method: str) -> list[Recording]:
        source = entry | {"split": {"method": method}}
        read = table_file.read(tmp_path / "arm.csv", dataset="arm", source=source)
        return [recording for subset in subsets if (recording := read[subset].recording) is not None]

    assert [set(recording.session.tolist()) for recording in recordings("session")] == [{1}, {1}, {2}]
    first, second, third = (recording.order for recording in recordings("later"))
    assert first.max() < second.min() <= second.max() < third.min()
    without = {key: value for key, value in entry.items() if key not in ("order", "session")}
    with pytest.raises(DataError, match="needs the order in time"):
        table_file.read(tmp_path / "arm.csv", dataset="arm", source=without | {"split": {"method": "later"}})
    with pytest.raises(DataError, match="one session, so there is no next one"):
        table_file.read(
            tmp_path / "arm.csv", dataset="arm", source=without | {"order": "when", "split": {"method": "session"}}
        )


def test_the_recorded_finger(published_mirror: Path, tmp_path: Path) -> None:
    """The rows are those of FINGER; cut or not, the memory is that of the whole recording."""
    sources = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
    raw, order = published_mirror / "FINGER.json", HOUSE / "resources" / "published" / "finger_recording_order.csv"
    plain = published_json.read(raw, dataset="finger", source=sources["finger"])
    for place, cut in enumerate((None, 50)):
        prepare(
            raw,
            dataset="finger_recorded",
            source=sources["finger_recorded"],
            table=tmp_path / f"{place}.parquet",
            description=tmp_path / f"{place}.json",
            order_table=order,
            kept=KeptRows(first=cut),
        )
    for subset in SUBSETS:
        whole, cut_rows = (read_subset(tmp_path / f"{place}.parquet", subset) for place in range(2))
        np.testing.assert_array_equal(whole.commands, plain[subset].commands)
        np.testing.assert_allclose(whole.positions, 1000 * plain[subset].positions)
        assert whole.recording is not None
        assert cut_rows.recording is not None
        np.testing.assert_array_equal(cut_rows.recording.memory, whole.recording.memory[:50])
    assert sources["finger_recorded"]["sha256"] == sources["finger"]["sha256"]


def test_a_stand_in_is_recorded_in_sessions_that_begin_at_rest() -> None:
    rows = simulate("tendon_finger_recorded", n_rows=60, seed=0)
    assert description(rows) == {"rows_of_session": {"1": 28, "2": 12, "3": 20}, "missing_poses": 0}
    assert simulate("tendon_finger_frictional", n_rows=20, seed=0)["train"].recording is None


def test_times_of_sessions_may_overlap_without_being_equal() -> None:
    """Clocks that begin anew with each trial, and never tick at the same fraction."""
    times, session = np.array([0.0, 0.1, 0.2, 0.05, 0.15, 0.25]), np.array([1, 1, 1, 2, 2, 2])
    found = recording_of(COMMANDS, times, session, place)
    assert found.order.tolist() == [1, 2, 3, 4, 5, 6]
    assert found.session.tolist() == [1, 1, 1, 2, 2, 2]
    with pytest.raises(DataError, match="stand between"):
        recording_of(COMMANDS, times, np.array([1, 2, 1, 2, 1, 2]), place)


def test_memory_does_not_reach_over_a_hole() -> None:
    commands = np.array([[0.0], [1.0], [np.nan], [3.0], [4.0], [5.0]])
    found = recording_of(commands, None, None, place)
    robot = CommandMemory.of(np.array([[0.0], [1.0], [3.0], [4.0], [5.0]]))
    assert found.order.tolist() == [1, 2, 3, 4, 5, 6]
    assert np.isnan(found.memory[2]).all()
    np.testing.assert_array_equal(found.memory[:2], robot.along(commands[:2]))
    np.testing.assert_array_equal(found.memory[3:], robot.along(commands[3:]))
    backwards = recording_of(commands[::-1], np.arange(6.0, 0.0, -1.0), None, place)
    np.testing.assert_array_equal(backwards.memory[::-1], found.memory)


def test_a_row_of_unknown_time_or_session_is_a_hole_too() -> None:
    session = np.array([1.0, 1.0, np.nan, 1.0, 2.0, 2.0])
    found = recording_of(COMMANDS, np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), session, place)
    robot = CommandMemory.of(COMMANDS)
    np.testing.assert_array_equal(found.memory[3], robot.along(COMMANDS[3:4])[0])
    np.testing.assert_array_equal(found.memory[4:], robot.along(COMMANDS[4:]))
    assert found.session.tolist() == [1, 1, 0, 1, 2, 2]


def test_a_clock_in_milliseconds_counts_no_poses() -> None:
    commands = np.random.default_rng(0).uniform(size=(50, 2))
    assert recording_of(commands, np.arange(50) * 20, None, place).order.tolist() == [*range(1, 51)]
    counted = np.delete(np.arange(51), 7)
    assert recording_of(commands, counted, None, place).order.tolist() == counted.tolist()
