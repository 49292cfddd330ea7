"""Registry of the paper's claims: a file for each group of them, one line each here, in the order of the paper."""

from __future__ import annotations

from softkin.reporting.claims import (
    approaches,
    data,
    forest_and_network,
    improvements,
    intervals,
    judgements,
    learning,
    linear,
    robustness,
    settings,
    time,
)
from softkin.reporting.claims.spec import ClaimSpec

CLAIMS: dict[str, ClaimSpec] = {
    claim.name: claim
    for claim in (
        robustness.MOST_ROBUST,
        intervals.GUARANTEE,
        judgements.LACK_INTERPRETABILITY,
        intervals.WHOLE_POSITIONS,
        approaches.PREDICTIVE_POWER,
        judgements.INTERPRETABILITY,
        time.TIME_INDEPENDENT,
        data.SIZES,
        data.HELD_OUT,
        data.DRIFT,
        settings.NEAR_OPTIMAL,
        settings.PRINTED_CELLS,
        linear.COMPETITIVE,
        linear.POOR,
        robustness.ALL_DEGRADE,
        robustness.BOOSTED_KEEP_BETTER,
        linear.OUTSHINE,
        linear.RANK_WORST,
        linear.FAIL,
        linear.PENALTY,
        forest_and_network.FOREST_WORSE,
        forest_and_network.UNREGULARISED,
        robustness.KERNELS_DEGRADE,
        forest_and_network.MODERATE,
        learning.NETWORK_NEEDS_DATA,
        robustness.BEST_CANDIDATES,
        intervals.BEST_COVERAGE,
        intervals.BEST_WINKLER,
        improvements.IMPROVEMENTS,
        intervals.UNCALIBRATED,
        intervals.CONFORMALIZED_BETTER,
        intervals.ONE_PACKAGE_BETTER,
        intervals.NARROWER,
    )
}
