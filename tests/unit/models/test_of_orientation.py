from __future__ import annotations

import numpy as np

from softkin.models import MODELS
from softkin.models.of_orientation import CANDIDATES


def test_candidates_are_of_the_pool_and_can_be_built() -> None:
    assert len(CANDIDATES) >= 2
    for spec, params in CANDIDATES:
        assert MODELS[spec.name] is spec
        commands = np.random.default_rng(0).standard_normal((20, 2))
        model = spec.build(params, 0, 1)
        model.fit(commands, commands @ np.ones((2, 3)))
        assert np.shape(model.predict(commands)) == (20, 3)
