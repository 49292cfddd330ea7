"""All checks together: what they say of clean robots, and of the published datasets."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from softkin.core.samples import ROWS_FOR_95_PERCENT, SUBSETS, Samples
from softkin.data.audit import CHECKS
from softkin.data.audit.cleaning import cleaned
from softkin.data.audit.findings import NOTE, Finding
from softkin.data.prepare import prepare
from softkin.data.table import read_subset
from tests.conftest import HOUSE
from tests.unit.data.audit.clean_robot import clean_robot

#: Rows, commands, markers, noise (mm).
ROBOTS = [
    (40, 1, 1, 0.1),
    (100, 2, 1, 0.0),
    (200, 3, 2, 0.1),
    (400, 2, 1, 0.1),
    (500, 64, 10, 0.1),
    (1000, 6, 3, 0.0),
    (2000, 2, 1, 5.0),
]


def findings_of(samples: dict[str, Samples]) -> list[Finding]:
    return [finding for check in CHECKS.values() for finding in check(samples).findings]


def alarms(n_rows: int, n_commands: int, n_markers: int, noise_mm: float, n_seeds: int) -> list[str]:
    """Codes above `note` that clean robots raise."""
    return [
        finding.code
        for seed in range(n_seeds)
        for finding in findings_of(clean_robot(n_rows, n_commands, n_markers, noise_mm, seed))
        if finding.severity != NOTE
    ]


def of_few_rows(n_rows: int, n_seeds: int) -> list[str]:
    """The one finding that a clean robot has, where `validation` is too small for intervals at 95 %."""
    n_validation = len(clean_robot(n_rows, 1, 1, 0.0, 0)["validation"])
    return ["few_calibration_rows"] * n_seeds if n_validation < ROWS_FOR_95_PERCENT else []


@pytest.mark.parametrize("size", ROBOTS, ids=str)
def test_clean_robots_raise_nothing(size: tuple[int, int, int, float]) -> None:
    assert alarms(*size, n_seeds=1) == of_few_rows(size[0], 1)


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("size", [*ROBOTS, (100, 1, 1, 0.1), (2000, 3, 2, 0.1), (5000, 3, 7, 0.0)], ids=str)
def test_the_false_alarm_rate_over_fifty_seeds_is_nil(size: tuple[int, int, int, float]) -> None:
    assert alarms(*size, n_seeds=50) == of_few_rows(size[0], 50)


def published(dataset: str, mirror: Path, folder: Path) -> dict[str, Samples]:
    source = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"][dataset]
    table = folder / "table.parquet"
    prepare(mirror / source["file"], dataset=dataset, source=source, table=table, description=folder / "dataset.json")
    return {subset: read_subset(table, subset) for subset in SUBSETS}


def test_elastica_leaks_whole(published_mirror: Path, tmp_path: Path) -> None:
    samples = published("elastica", published_mirror, tmp_path)
    findings = findings_of(samples)
    leaks = {finding.subsets[0]: finding for finding in findings if finding.severity == "leak"}
    assert set(leaks) == {"validation", "test"}
    assert all("140 of 140 rows" in finding.sentence for finding in leaks.values())
    assert {finding.code for finding in findings} == {"copied_commands", "few_distinct_commands", "duplicate_rows"}
    few = next(finding for finding in findings if finding.code == "few_distinct_commands")
    assert "only 40 distinct commands; train has 28 in 1120 rows" in few.sentence
    assert cleaned(samples)[1] == {"stuck_rows": 0, "duplicate_rows": 1092}


def test_abaqus_has_a_constant_marker_stuck_poses_and_one_outlier(published_mirror: Path, tmp_path: Path) -> None:
    samples = published("abaqus", published_mirror, tmp_path)
    findings = {finding.code: finding for finding in findings_of(samples)}
    assert set(findings) == {"constant_coordinates", "stuck_poses", "gross_outliers"}
    assert "m1_x, m1_y, m1_z (marker 1 as a whole)" in findings["constant_coordinates"].sentence
    assert findings["stuck_poses"].n_rows == {"train": 29, "validation": 5, "test": 5}
    assert findings["gross_outliers"].rows == {"extrapolation": (147,)}
    kept, removed = cleaned(samples)
    assert removed == {"stuck_rows": 29, "duplicate_rows": 0}
    assert len(kept["train"]) == 3160 - 29


@pytest.mark.parametrize("dataset", ["elastica_2023_09", "finger"])
def test_the_other_two_are_sound(dataset: str, published_mirror: Path, tmp_path: Path) -> None:
    samples = published(dataset, published_mirror, tmp_path)
    assert findings_of(samples) == []
    assert cleaned(samples)[1] == {"stuck_rows": 0, "duplicate_rows": 0}
