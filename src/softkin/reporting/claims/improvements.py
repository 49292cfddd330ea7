"""The claim of how much split conformal prediction improves on quantile regression, in percent."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from softkin.reporting.claims.intervals import OTHER_SCP, QR, SCP, Score, of_methods
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec

#: Percent points that rounding may take.
ROUNDING = 0.5 + 1e-9
Gains = tuple[float, float]


def gains(coverage: Mapping[str, float], winkler: Mapping[str, float], method: str) -> Gains:
    """By how many percent a method covers more than QR, and how many its Winkler score is smaller."""
    return 100 * (coverage[method] / coverage[QR] - 1), 100 * (1 - winkler[method] / winkler[QR])


def _improvements(measured: Measured) -> Iterator[Case]:
    """As printed: whether one column of Table 6 gives both numbers of a dataset. With our averages: whether both are
    reached.
    """
    said = measured.frames["improvements"].set_index("dataset")
    printed = measured.frames["published_intervals"]
    for dataset in said.index:
        cells = printed[printed["dataset"] == dataset].pivot_table(
            index="interval_method", columns="metric", values="printed", aggfunc="first"
        )
        if dataset not in measured.datasets or not {QR, SCP, OTHER_SCP} <= set(cells.index):
            continue
        numbers = cells.astype(float).to_dict()
        found = {method: gains(numbers["coverage"], numbers["winkler_mm"], method) for method in (SCP, OTHER_SCP)}
        goal = (said.loc[dataset, "coverage_percent"], said.loc[dataset, "winkler_percent"])
        holds = any(all(abs(a - b) <= ROUNDING for a, b in zip(goal, pair, strict=True)) for pair in found.values())
        text = ", ".join(f"{method} {pair[0]:.0f} %/{pair[1]:.0f} %" for method, pair in found.items())
        yield Case("as printed", str(dataset), holds, f"said {goal[0]} %/{goal[1]} %, {text}")
    least = said.min()

    def reached(score: Score) -> tuple[bool, str]:
        coverage, winkler = ({m: score(m, metric) for m in (QR, SCP)} for metric in ("coverage", "winkler_mm"))
        pair = gains(coverage, winkler, SCP)
        is_reached = pair[0] >= least["coverage_percent"] - 1 and pair[1] >= least["winkler_percent"] - 1
        return is_reached, f"{pair[0]:.0f} %/{pair[1]:.0f} %"

    yield from of_methods(measured, (QR, SCP), reached)


IMPROVEMENTS = ClaimSpec(
    name="scp_improvements",
    text="SCP improves coverage/Winkler by 23 %/41 % (ABAQUS), 23 %/57 % (ELASTICA), 27 %/73 % (FINGER)",
    where="section 4, conformal prediction",
    rule=_improvements,
    rule_text="as printed: one SCP column of Table 6 gives both percentages against QR; of our averages: at least the "
    "smallest that are stated",
    table="published_intervals.csv",
    missing="QR and SCP around the paper's model on complete published robots",
    robots=2,
)
