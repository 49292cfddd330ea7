"""Normalised split conformal prediction: wider where the model itself is unsure."""

from __future__ import annotations

from collections.abc import Sequence

from softkin.conformal import conformal_rank, normalised_intervals
from softkin.interface import MARGINAL, Array, Evidence, IntervalMethod

#: Added to every spread, as a share of its mean over `train`: a forest's trees may agree by chance.
LEAST_SHARE = 0.1


def intervals(evidence: Evidence, confidence_levels: Sequence[float]) -> Array:
    """Half-width proportional to the model's own spread: of a forest's trees, of a Gaussian process' posterior, of a
    network's last layer.

    So calibrated, the interval of a Gaussian process or a Bayesian network covers what it says.
    Source: Lei et al. (2018), section 5.2; crepes.ConformalRegressor with `sigmas`.
    """
    assert evidence.train_spread is not None
    assert evidence.calibration_spread is not None
    assert evidence.new_spread is not None
    least = LEAST_SHARE * evidence.train_spread.mean(axis=0)
    return normalised_intervals(
        evidence, confidence_levels, evidence.calibration_spread + least, evidence.new_spread + least
    )


METHOD = IntervalMethod(
    "scp_spread", "SCP, by spread", on="spreads", guarantee=MARGINAL, intervals=intervals, rank=conformal_rank
)
