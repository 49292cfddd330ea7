from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.data.audit.subset_shift import check
from tests.unit.data.audit.clean_robot import clean_robot
from tests.unit.data.audit.conftest import Replace


def test_a_test_subset_from_elsewhere_is_a_finding(robot: dict[str, Samples], changed: Replace) -> None:
    result = check(changed("test", slice(None), commands=robot["test"].commands * 0.3 + [0.5, 0.0]))
    (finding,) = result.findings
    assert (finding.code, finding.severity, finding.subsets) == ("shifted_subset", "warning", ("test",))
    assert "u1" in finding.sentence
    assert result.numbers["test"]["auc"] > 0.8


def test_a_marker_registered_anew_before_the_test_is_a_finding(robot: dict[str, Samples], changed: Replace) -> None:
    """Positions have moved, commands have not."""
    shift = np.array([0, 0, 0, 100.0, 0, 0])
    (finding,) = check(changed("test", slice(None), positions=robot["test"].positions + shift)).findings
    assert "m2_x" in finding.sentence


def test_an_extrapolation_subset_drawn_like_train_is_a_finding() -> None:
    whole = clean_robot(3000, seed=4)["train"]
    parts = np.split(np.arange(len(whole)), [800, 1000, 1200])
    names = ("train", "validation", "test", "extrapolation")
    samples = {n: Samples(whole.commands[p], whole.positions[p]) for n, p in zip(names, parts, strict=True)}
    (finding,) = check(samples).findings
    assert (finding.code, finding.subsets) == ("extrapolation_like_train", ("extrapolation",))


@pytest.mark.parametrize("n_commands", [1, 2, 6])
def test_a_random_split_with_an_outer_shell_is_no_finding(n_commands: int) -> None:
    result = check(clean_robot(600, n_commands=n_commands, seed=5))
    assert not result.findings
    assert result.numbers["extrapolation"]["auc"] > 0.95
    assert set(result.numbers["test"]["columns"]) == {*(f"u{i + 1}" for i in range(n_commands)), "m1_x", "m1_y", "m1_z"}


def test_with_a_few_rows_no_classifier_is_asked() -> None:
    result = check(clean_robot(60, seed=5))
    assert not result.findings
    assert result.numbers["test"]["auc"] is None


def test_a_shift_is_measured_in_its_unit(robot: dict[str, Samples]) -> None:
    samples = {**robot, "test": Samples(robot["train"].commands + np.array([1.0, 0.0]), robot["train"].positions + 2.5)}
    columns = check(samples).numbers["test"]["columns"]
    assert columns["m1_x"]["wasserstein"] == pytest.approx(2.5)
    assert columns["u1"]["wasserstein"] == pytest.approx(1 / robot["train"].commands[:, 0].std())
    assert columns["u2"] == {"ks": 0.0, "wasserstein": 0.0}
