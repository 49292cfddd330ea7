from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.samples import SUBSETS, Samples
from softkin.data.audit.ambiguous_commands import check
from softkin.data.readers import table_file
from tests.conftest import HOUSE

CODE = "command_does_not_determine_pose"


def repeated(branch_mm: float, noise_mm: float, jitter: float = 0.0) -> dict[str, Samples]:
    """40 commands, each 10 times; half of the rows lie on a branch `branch_mm` aside."""
    rng = np.random.default_rng(0)
    commands = np.repeat(rng.uniform(-1, 1, (40, 2)), 10, axis=0)
    positions = np.hstack([50 * commands, 100 - 20 * (commands**2).sum(axis=1, keepdims=True)])
    positions[::2, 0] += branch_mm
    positions += noise_mm * rng.standard_normal(positions.shape)
    commands = commands + jitter * rng.standard_normal(commands.shape)
    places = rng.integers(0, 4, len(commands))
    return {name: Samples(commands[places == i], positions[places == i]) for i, name in enumerate(SUBSETS)}


@pytest.mark.parametrize("jitter", [0.0, 1e-4])
def test_two_branches_at_one_command_are_found_with_their_distance(jitter: float) -> None:
    result = check(repeated(9.0, 0.1, jitter))
    (finding,) = result.findings
    assert (finding.code, finding.subsets) == (CODE, SUBSETS)
    assert result.numbers["far_mm"] == pytest.approx(9.0, abs=0.5)
    assert "session" in finding.consequence


@pytest.mark.parametrize(("branch_mm", "noise_mm"), [(0.0, 0.1), (0.0, 8.0), (0.0, 0.0), (0.5, 0.2)])
def test_noise_is_no_finding(branch_mm: float, noise_mm: float) -> None:
    assert not check(repeated(branch_mm, noise_mm)).findings


def test_without_repeated_commands_nothing_is_measured(robot: dict[str, Samples]) -> None:
    result = check(robot)
    assert not result.findings
    assert "not_measured" in result.numbers


def test_case_28_a_loop_with_hysteresis_is_named_with_its_spread() -> None:
    entry: dict[str, Any] = {"file": "28", "position_unit": "mm", "commands": ["u1"], "positions": ["x", "y", "z"]}
    entry |= {"split": {"method": "random"}}
    path = HOUSE / "tests" / "cases" / "28_hysteresis_loop.csv"
    (finding,) = check(table_file.read(path, dataset="arm", source=entry)).findings
    assert finding.code == CODE
    assert "poses lie 9 mm apart" in finding.sentence
