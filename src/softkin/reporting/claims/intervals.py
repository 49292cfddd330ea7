"""Claims on intervals: what they promise, and how split conformal prediction compares with quantile regression."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from softkin.core.runs import PAPER, TUNED
from softkin.core.samples import EXTRAPOLATION, TEST, VALIDATION
from softkin.evaluation.recorded_names import NEXT_SESSION, PLAIN
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.claims.measured import Interval, Measured
from softkin.reporting.claims.spec import Case, ClaimSpec
from softkin.reporting.tables.numbers import number_text, share_text

QR, CQR, SCP, OTHER_SCP = "qr", "cqr", "scp_mapie", "scp_crepes"
SECTION, TABLE = "section 4, conformal prediction", "interval_metrics.csv"
MISSING = "QR, CQR and SCP around the paper's model on complete published robots"
LEVEL = 0.9
#: Where coverage is as said, it is so for at least this share of the coordinates.
MOST_COORDINATES = 0.8
#: Numbers that agree to this are the same.
SAME = 1e-9
Score = Callable[[str, str], float]


def of_methods(
    measured: Measured, methods: Sequence[str], holds: Callable[[Score], tuple[bool, str]]
) -> Iterator[Case]:
    """A case per preset of the paper's model and dataset whose test and validation do not leak: what `holds` says of
    `score(method, metric)` on test.
    """
    for preset in (PAPER, TUNED):
        run = (PAPERS_RUN.model, preset)
        for dataset, _ in measured.places([TEST]):
            keys = [Interval(dataset, TEST, *run, method, "winkler_mm") for method in methods]
            if (dataset, VALIDATION) in measured.leaks or not all(key in measured.intervals for key in keys):
                continue

            def score(method: str, metric: str, dataset: str = dataset, run: tuple[str, str] = run) -> float:
                return measured.intervals[Interval(dataset, TEST, *run, method, metric)]

            yield Case(f"around {' '.join(run)}", f"{dataset} {TEST}", *holds(score))


def _guarantee(measured: Measured) -> Iterator[Case]:
    """In-domain, in extrapolation, and in sessions never seen."""
    for subset, setting in ((TEST, "in-domain"), (EXTRAPOLATION, "in extrapolation")):
        for dataset, _ in measured.places([subset]):
            counts = measured.bands.get((dataset, subset, *PAPERS_RUN, SCP))
            if counts is not None and (dataset, VALIDATION) not in measured.leaks:
                coverage = measured.score(dataset, subset, PAPERS_RUN, SCP, "coverage")
                number = f"{share_text(coverage)}, {counts[0]} of {counts[1]} coordinates as said"
                yield Case(setting, f"{dataset} {subset}", counts[0] >= MOST_COORDINATES * counts[1], number)
    recorded = measured.frames.get("recorded")
    if recorded is not None:
        plain = recorded[(recorded["split"] == NEXT_SESSION) & (recorded["method"] == PLAIN)]
        for row in plain.itertuples():
            if row.dataset in measured.datasets:
                place = f"{row.dataset} {row.subset}, memory {row.memory}"
                yield Case("in a new session", place, row.coverage >= LEVEL, share_text(row.coverage))


def _whole_positions(measured: Measured) -> Iterator[Case]:
    for (dataset, subset, model, preset, method), (share, is_enough) in measured.joint.items():
        around_paper = (model, preset) == tuple(PAPERS_RUN) and (dataset, subset) in measured.places([TEST])
        if around_paper and method == SCP and (dataset, VALIDATION) not in measured.leaks:
            yield Case("coordinate by coordinate", f"{dataset} {subset}", is_enough, f"{share_text(share)} of poses")


def _best_coverage(score: Score) -> tuple[bool, str]:
    coverage = {method: score(method, "coverage") for method in (QR, CQR, SCP)}
    text = ", ".join(f"{method} {share_text(value)}" for method, value in coverage.items())
    return coverage[SCP] == max(coverage.values()), text


def _best_winkler(score: Score) -> tuple[bool, str]:
    scores = {method: score(method, "winkler_mm") for method in (QR, CQR, SCP)}
    text = ", ".join(f"{method} {number_text(value)}" for method, value in scores.items())
    return scores[SCP] == min(scores.values()), text


def _uncalibrated(measured: Measured) -> Iterator[Case]:
    """Of 'may not be': one robot is enough, so that the worst one is the case."""
    of_quantiles = [
        (n / of, dataset, run, f"{n} of {of} coordinates as said")
        for (dataset, subset, *run, method), (n, of) in measured.bands.items()
        if method == QR and run[0] == PAPERS_RUN.model and (dataset, subset) in measured.places([TEST])
    ]
    for preset in (PAPER, TUNED):
        of_preset = [case for case in of_quantiles if case[2][1] == preset]
        if of_preset:
            share, dataset, run, number = min(of_preset)
            yield Case(f"around {' '.join(run)}", f"{dataset} {TEST}", share < MOST_COORDINATES, number)


def _conformalized_better(score: Score) -> tuple[bool, str]:
    off = {method: abs(score(method, "coverage") - LEVEL) for method in (QR, CQR)}
    winkler = {method: score(method, "winkler_mm") for method in (QR, CQR)}
    is_no_worse = winkler[CQR] <= winkler[QR] * (1 + SAME)
    text = f"off the level by {share_text(off[CQR])} for {share_text(off[QR])}"
    text += f", {number_text(winkler[CQR])} for {number_text(winkler[QR])} mm"
    return off[CQR] < off[QR] and is_no_worse, text


def _one_package_better(measured: Measured) -> Iterator[Case]:
    def holds(score: Score) -> tuple[bool, str]:
        one, other = (score(method, "winkler_mm") for method in (SCP, OTHER_SCP))
        text = f"{number_text(one)} and {number_text(other)} mm" if abs(one - other) > SAME * other else "the same"
        return one < other * (1 - SAME), text

    yield from of_methods(measured, (SCP, OTHER_SCP), holds)
    printed = measured.frames["published_intervals"]
    for dataset in [name for name in printed["dataset"].unique() if name in measured.datasets]:
        cells = printed[(printed["dataset"] == dataset) & (printed["metric"] == "winkler_mm")]
        values = cells.set_index("interval_method")["printed"].astype(float)
        if {SCP, OTHER_SCP} <= set(values.index):
            number = f"Winkler {values[SCP]:g} and {values[OTHER_SCP]:g} mm"
            yield Case("as printed", str(dataset), values[SCP] < values[OTHER_SCP], number)


def _narrower(score: Score) -> tuple[bool, str]:
    width = {method: score(method, "mean_width_mm") for method in (SCP, QR)}
    return width[SCP] < width[QR], f"{number_text(width[SCP])} for {number_text(width[QR])} mm"


GUARANTEE = ClaimSpec(
    name="coverage_guaranteed",
    text="split conformal prediction ensures distribution-free intervals with a guaranteed coverage of true positions",
    where="abstract; sections 1 and 3",
    rule=_guarantee,
    rule_text=f"around the paper's model at {LEVEL:.0%}: at least {MOST_COORDINATES:.0%} of the coordinates are "
    "covered as often as that but for chance (5 %, by Holm where a coverage is promised); in a new session, around the "
    "deployed model, mean coverage is at least the level",
    table=TABLE,
    missing="SCP around the paper's model on complete published robots",
    robots=2,
)
WHOLE_POSITIONS = ClaimSpec(
    name="whole_positions_covered",
    text="true positions of the end effectors lie in the prediction set with the specified confidence",
    where="sections 1 and 3",
    rule=_whole_positions,
    rule_text=f"all coordinates of a pose at once lie in intervals of {LEVEL:.0%} as often as that but for chance",
    table=TABLE,
    missing="SCP around the paper's model on complete published robots",
    robots=2,
)
BEST_COVERAGE = ClaimSpec(
    name="scp_best_coverage",
    text="SCP yields the best performance for coverage",
    where=f"{SECTION}; table 6",
    rule=partial(of_methods, methods=(QR, CQR, SCP), holds=_best_coverage),
    rule_text="the highest mean coverage of QR, CQR and SCP on test is that of SCP, on each robot",
    table=TABLE,
    missing=MISSING,
    robots=2,
)
BEST_WINKLER = ClaimSpec(
    name="scp_best_winkler",
    text="SCP yields the best performance for the Winkler score",
    where=f"{SECTION}; table 6; conclusions",
    rule=partial(of_methods, methods=(QR, CQR, SCP), holds=_best_winkler),
    rule_text="the smallest mean Winkler score of QR, CQR and SCP on test is that of SCP, on each robot",
    table=TABLE,
    missing=MISSING,
    robots=2,
)
UNCALIBRATED = ClaimSpec(
    name="qr_not_calibrated",
    text="QR intervals may not be calibrated: the actual coverage might be off from the desired level",
    where=SECTION,
    rule=_uncalibrated,
    rule_text=f"on some robot less than {MOST_COORDINATES:.0%} of coordinates are covered as said but for chance",
    table=TABLE,
    missing="QR on complete published robots",
)
CONFORMALIZED_BETTER = ClaimSpec(
    name="cqr_outperforms_qr",
    text="CQR outperforms QR, suggesting that calibration assists",
    where=SECTION,
    rule=partial(of_methods, methods=(QR, CQR), holds=_conformalized_better),
    rule_text="coverage of CQR nearer to the level than that of QR, with no larger Winkler score, on each robot",
    table=TABLE,
    missing="QR and CQR around the paper's model on complete published robots",
    robots=2,
)
ONE_PACKAGE_BETTER = ClaimSpec(
    name="mapie_better_than_crepes",
    text="the SCP of MAPIE performs slightly better than that of CREPES",
    where=SECTION,
    rule=_one_package_better,
    rule_text="mean Winkler score with MAPIE below that with crepes, of one model and level; and of the printed cells",
    table=TABLE,
    missing="SCP by both packages around the paper's model on complete published robots",
    robots=2,
)
NARROWER = ClaimSpec(
    name="scp_narrower",
    text="SCP produces narrower prediction intervals than QR",
    where=SECTION,
    rule=partial(of_methods, methods=(QR, SCP), holds=_narrower),
    rule_text="mean width of SCP on test below that of QR, on each robot",
    table=TABLE,
    missing=MISSING,
    robots=2,
)
