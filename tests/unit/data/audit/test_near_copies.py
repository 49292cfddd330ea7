from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.data.audit.findings import LEAK, WARNING
from softkin.data.audit.near_copies import check
from tests.unit.data.audit.conftest import Replace


def jittered_bunches(jitter: float, n_bunches: int = 30, each: int = 40) -> dict[str, Samples]:
    """Few commands, each repeated with jitter, the repetitions spread over the subsets."""
    rng = np.random.default_rng(0)
    commands = np.repeat(rng.uniform(-1, 1, (n_bunches, 2)), each, axis=0)
    commands = rng.permutation(commands + jitter * rng.standard_normal(commands.shape))
    parts = np.split(commands, [round(share * len(commands)) for share in (0.7, 0.8, 0.9)])
    names = ("train", "validation", "test", "extrapolation")
    return {name: Samples(part, np.zeros((len(part), 3))) for name, part in zip(names, parts, strict=True)}


def test_copies_with_jitter_are_a_leak(robot: dict[str, Samples], changed: Replace) -> None:
    jitter = 1e-6 * np.random.default_rng(0).standard_normal((25, 2))
    first = robot["train"].take(slice(25))
    result = check(changed("test", slice(0, 25), commands=first.commands + jitter, positions=first.positions))
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("near_copied_commands", LEAK)
    assert finding.rows["test"] == tuple(range(25))
    assert result.numbers["test"]["near_copies"] == 25
    anew = check(changed("test", slice(0, 25), commands=first.commands + jitter, positions=first.positions + 3.0))
    assert [(finding.code, finding.severity) for finding in anew.findings] == [("near_copied_commands", WARNING)]


def test_bunches_in_train_itself_do_not_hide_them() -> None:
    findings = check(jittered_bunches(1e-4)).findings
    assert {finding.subsets for finding in findings} == {("validation",), ("test",), ("extrapolation",)}
    assert all(sum(finding.n_rows.values()) > 100 for finding in findings)


def test_exact_copies_are_left_to_their_own_check(robot: dict[str, Samples], changed: Replace) -> None:
    assert not check(changed("test", slice(0, 49), commands=robot["train"].commands[:49])).findings


@pytest.mark.parametrize("n_commands", [1, 2, 6])
def test_independent_commands_are_no_finding_however_unevenly_they_lie(n_commands: int) -> None:
    rng = np.random.default_rng(n_commands)
    for _ in range(5):
        # Half of the rows explore a corner a hundred times as closely as the rest.
        commands = rng.standard_normal((2000, n_commands)) ** 3
        commands[::2] = 5 + commands[::2] / 100
        parts = np.split(rng.permutation(commands), [1400, 1600, 1800])
        names = ("train", "validation", "test", "extrapolation")
        samples = {name: Samples(part, np.zeros((len(part), 3))) for name, part in zip(names, parts, strict=True)}
        assert not check(samples).findings


def test_a_grid_is_no_finding() -> None:
    grid = np.stack(np.meshgrid(np.arange(30.0), np.arange(30.0)), axis=-1).reshape(-1, 2)
    parts = np.split(np.random.default_rng(0).permutation(grid), [600, 700, 800])
    names = ("train", "validation", "test", "extrapolation")
    samples = {name: Samples(part, np.zeros((len(part), 3))) for name, part in zip(names, parts, strict=True)}
    result = check(samples)
    assert not result.findings
    assert result.numbers["typical_spacing"] == pytest.approx(1 / samples["train"].commands.std(axis=0).max(), rel=0.05)


def test_with_two_train_commands_nothing_is_measured(changed: Replace) -> None:
    samples = changed("train", slice(0, None, 2), commands=[0.0, 0.1])
    result = check(changed("train", slice(1, None, 2), commands=[0.2, 0.1], of=samples))
    assert not result.findings
    assert "fewer than 3" in result.numbers["not_measured"]
