"""The check for a robot that lives in time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from softkin.core.samples import SUBSETS, Array, Samples
from softkin.data.audit.findings import Finding
from softkin.data.audit.memory import OPTIMISTIC, check
from softkin.data.prepare import prepare
from softkin.data.table import read_subset
from tests.conftest import HOUSE
from tests.recorded_robot import recorded_arm
from tests.unit.data.audit.clean_robot import clean_robot


def subsets(rows: Samples, seed: int = 0) -> dict[str, Samples]:
    """Of all rows 56, 7, 7 and 30 %, the last those of largest command norm."""
    order = np.argsort(np.linalg.norm(rows.commands, axis=1), kind="stable")
    inner, outer = np.split(order, [int(0.7 * len(rows))])
    inner = np.random.default_rng(seed).permutation(inner)
    parts = [*np.split(inner, [int(0.8 * len(inner)), int(0.9 * len(inner))]), outer]
    return {subset: rows.take(part) for subset, part in zip(SUBSETS, parts, strict=True)}


def found(rows: Samples, seed: int = 0) -> dict[str, Finding]:
    return {finding.code: finding for finding in check(subsets(rows, seed)).findings}


@pytest.mark.parametrize("seed", range(3))
def test_a_memoryless_robot_raises_nothing(seed: int) -> None:
    assert found(recorded_arm(400, zeros_mm=(0.0, 0.0, 0.0), seed=seed), seed) == {}


@pytest.mark.slow
def test_false_alarms_are_rare() -> None:
    """300 memoryless robots of three sessions, some sampled along a slow path: at most one in a hundred raises one."""
    alarms = [
        found(path(recorded_arm(300, zeros_mm=(0.0,) * 3, seed=seed), seed % 3 == 0), seed) for seed in range(300)
    ]
    assert sum(bool(alarm) for alarm in alarms) <= 3


def path(rows: Samples, is_slow: bool) -> Samples:
    """The robot as it is, or one whose commands move slowly along a path."""
    if not is_slow:
        return rows
    when = np.arange(len(rows)) / 7.0
    commands: Array = np.column_stack([np.sin(when), np.cos(0.73 * when)])
    return recorded_arm(len(rows), zeros_mm=(0.0,) * 3, seed=int(rows.commands[0, 0] * 1e6) % 1000, commands=commands)


@pytest.mark.parametrize("seed", range(3))
def test_backlash_of_two_percent_of_the_range_is_found(seed: int) -> None:
    finding = found(recorded_arm(400, backlash=0.02, seed=seed), seed)["remembers"]
    assert "The robot remembers" in finding.sentence
    assert set(finding.subsets) == set(SUBSETS)


def test_a_shifted_zero_is_found_in_mm() -> None:
    rows = recorded_arm(500, zeros_mm=(0.0, 1.0))
    assert set(found(rows)) == {"sessions_differ"}
    numbers = check(subsets(rows)).numbers["sessions_differ"]
    assert numbers["effect_mm"]["m1_x"] == pytest.approx(1.0, abs=0.1)
    assert numbers["effect_mm"]["m1_y"] < 0.1
    assert numbers["p_value"] == 0.001


def test_a_drift_is_found_in_mm() -> None:
    rows = recorded_arm(500)
    rows.positions[:, 2] += np.linspace(0, 0.8, 500)
    assert "m1_z" in found(rows)["drifts"].sentence
    assert check(subsets(rows)).numbers["drifts"]["effect_mm"]["m1_z"] == pytest.approx(0.8, abs=0.15)


def test_neighbours_in_time_make_a_random_split_optimistic() -> None:
    findings = check(subsets(recorded_arm(600, backlash=0.05))).findings
    beside = [finding for finding in findings if finding.code == "neighbours_in_time"]
    assert [finding.subsets for finding in beside] == [("validation",), ("test",)]
    assert all(finding.sentence.startswith(OPTIMISTIC) for finding in beside)


def test_without_a_recording_nothing_is_measured() -> None:
    assert check(clean_robot(200)).numbers == {"not_measured": "no recording order, or too few rows of it"}


def test_finger_has_the_numbers_of_its_recording(published_mirror: Path, tmp_path: Path) -> None:
    """Those of the data's description: seen on all rows, before any code made use of the order."""
    source = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]["finger_recorded"]
    table = tmp_path / "table.parquet"
    prepare(
        published_mirror / "FINGER.json",
        dataset="finger_recorded",
        source=source,
        table=table,
        description=tmp_path / "about.json",
        order_table=HOUSE / "resources" / "published" / source["order"]["file"],
    )
    result = check({subset: read_subset(table, subset) for subset in SUBSETS})
    codes = {finding.code for finding in result.findings}
    assert codes == {"remembers", "sessions_differ", "neighbours_in_time"}
    memory, zeros = result.numbers["remembers"], result.numbers["sessions_differ"]
    assert [memory["lag_one"][name] for name in ("m1_x", "m1_y")] == pytest.approx([0.55, 0.63], abs=0.011)
    assert [memory["lag_one_within_sessions"][name] for name in ("m1_x", "m1_y")] == pytest.approx(
        [0.30, 0.42], abs=0.011
    )
    assert max(zeros["effect_mm"].values()) == pytest.approx(3.5, abs=0.05)
    assert memory["p_value"] == zeros["p_value"] == 0.001
