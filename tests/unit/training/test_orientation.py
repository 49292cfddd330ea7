from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.core.rotations import angles
from softkin.core.samples import Samples
from softkin.models.of_orientation import CANDIDATES
from softkin.training import orientation
from softkin.training.orientation import fit_orientation, held_out_angles
from tests.oriented_robot import NOISE_DEGREES, about_one_mean, oriented_arm
from tests.recorded_robot import with_recording

ROWS, _ = about_one_mean({"train": oriented_arm(80), "test": oriented_arm(40, seed=5)})
#: Of three components of noise, the mean length.
NOISE = NOISE_DEGREES * np.sqrt(8 / np.pi)


def test_the_best_on_held_out_folds_is_fitted_and_predicts_to_the_noise() -> None:
    fitted = fit_orientation(ROWS["train"], seed=0, threads=1)
    turned = replace(ROWS["train"], positions=np.asarray(ROWS["train"].orientation))
    names = {spec.name: spec for spec, _ in CANDIDATES}
    np.testing.assert_array_equal(fitted.held_out_angles, held_out_angles(names[fitted.name], fitted.settings, turned))
    assert NOISE < fitted.held_out_angles.mean() < 1.5 * NOISE
    missed = angles(fitted.estimator.predict(ROWS["test"].inputs), np.asarray(ROWS["test"].orientation))
    assert 0.8 * NOISE < missed.mean() < 1.5 * NOISE


def test_a_recording_is_fitted_with_its_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(orientation, "CANDIDATES", CANDIDATES[:1])
    recorded: Samples = with_recording(ROWS)["train"]
    fitted = fit_orientation(recorded, seed=0, threads=1)
    assert fitted.settings.memory is not None
    assert fitted.estimator.predict(recorded.inputs).shape == (80, 3)
