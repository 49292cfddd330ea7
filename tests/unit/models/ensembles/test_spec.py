from __future__ import annotations

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from softkin.models.ensembles.spec import EnsembleSpec
from softkin.models.spec import PointModel


def test_an_ensemble_is_a_point_model_without_traits_by_default() -> None:
    spec = EnsembleSpec(name="first", title="First", family="ensemble", steps=lambda of, *_: np.eye(len(of))[:1])
    assert isinstance(spec, PointModel)
    assert spec.spread is None
    assert (spec.is_predictive, spec.is_cheap, spec.is_robust) == (False, False, False)
    with pytest.raises(FrozenInstanceError):
        spec.title = "Other"  # type: ignore[misc]
