from __future__ import annotations

import numpy as np

from softkin.uncertainty.conformal import weighted_limits
from softkin.uncertainty.labelled.weighted import answer
from tests.unit.uncertainty.conftest import LEVELS
from tests.unit.uncertainty.labelled.conftest import labelled


def test_diagnostics_tell_how_much_calibration_is_left_and_a_level_without_enough_is_refused() -> None:
    near, far = (answer(labelled(norms=norms), LEVELS, 0) for norms in ((0, 1), (1.1, 2.0)))
    assert near.details["domain_auc"] < 0.6
    assert near.details["effective_size"] > 100
    assert far.details["domain_auc"] > 0.999
    assert np.isinf(far.half_widths).mean() > 0.99
    nothing = answer(labelled(n=12, norms=(1.1, 2.0)), [0.8, 0.95], 0)
    size = nothing.details["effective_size"]
    assert size < 20
    assert nothing.refused[1] == f"{size:.1f} effective calibration rows, fewer than 1/alpha"


def test_weights_restore_the_coverage_under_a_shift_that_stays_within_train() -> None:
    """New commands from the outer third of the disc: plain split conformal prediction covers too little of them."""
    plain, weighted = [], []
    for seed in range(60):
        rows = labelled(n=400, seed=seed, norms=(0.6, 1.0))
        errors = np.abs(rows.errors)
        equal = weighted_limits(np.abs(rows.calibration_errors), np.ones(400), np.ones(200), [0.9])[0]
        plain.append((errors <= equal).mean())
        weighted.append((errors <= answer(rows, [0.9], 0).half_widths[0]).mean())
    assert np.mean(plain) < 0.87
    assert 0.89 < np.mean(weighted) < 0.95
