"""Check for a robot that lives in time: it remembers its commands, its zero differs between sessions, or it drifts.

Residuals of a smooth fit by commands alone are looked at in the order of the recording. Each finding needs an effect
that is large beside the scatter of residuals, and that permutations of the recording do not bring about: of rows where
the question is whether neighbours in time are alike, of long stretches where it is whether sessions or their ends are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from softkin.core.rows import command_scale
from softkin.core.samples import TEST, TRAIN, VALIDATION, Array, Samples
from softkin.core.time_residuals import TimeResiduals, lag_one, time_residuals
from softkin.data.audit.findings import NEIGHBOURS_IN_TIME, WARNING, CheckResult, Finding

N_PERMUTATIONS, ENOUGH, CHANCE = 999, 20, 0.002
#: Effects below this share of the residuals' scatter are no finding: correlation with the neighbour in time, or share
#: of variance that memory explains; shift of a zero; drift over a session.
LARGE_MEMORY, LARGE_ZERO, LARGE_DRIFT = 0.1, 0.3, 0.5
#: Neighbours in command space, whose mean is subtracted: what the fit misses there is no memory.
N_NEIGHBOURS = 6
MAX_ROWS, STRETCH, SMALL_SESSION = 5_000, 20, 30
OPTIMISTIC = "optimistic: neighbours in time stand in train"


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """Findings `remembers`, `sessions_differ`, `drifts`; and `neighbours_in_time` where the first makes test scores
    optimistic.
    """
    known = time_residuals(samples)
    if known is None:
        return CheckResult((), {"not_measured": "no recording order, or too few rows of it"})
    if len(known.order) > MAX_ROWS:
        known = _part(known, slice(MAX_ROWS))
    subsets = tuple(samples)
    parts = [
        part(known, subsets, np.random.default_rng([seed, place]))
        for place, part in enumerate((_remembers, _sessions_differ, _drifts))
    ]
    findings = [finding for finding, _ in parts if finding is not None]
    if any(finding.code == "remembers" for finding in findings):
        findings += _neighbours(samples)
    numbers = {"rows_looked_at": len(known.order), "degree_of_fit": known.degree, "permutations": N_PERMUTATIONS}
    for _, measured in parts:
        numbers |= measured
    return CheckResult(tuple(findings), numbers)


def _part(known: TimeResiduals, rows: slice) -> TimeResiduals:
    fields = ("residuals", "order", "session", "commands", "step", "stops")
    return replace(known, **{name: getattr(known, name)[rows] for name in fields})


def _p_value(statistic: Callable[[Any], float], observed: float, draw: Callable[[], Any]) -> float:
    """Share of permutations that bring as much, the observed one among them; ended once `ENOUGH` have done so, which
    keeps it a p-value (Besag and Clifford 1991).
    """
    reached = 0
    for drawn in range(1, N_PERMUTATIONS + 1):
        reached += statistic(draw()) >= observed
        if reached == ENOUGH:
            return reached / drawn
    return (1 + reached) / (1 + N_PERMUTATIONS)


def _by_coordinate(names: tuple[str, ...], values: Array) -> dict[str, float]:
    return {name: round(float(value), 4) for name, value in zip(names, values, strict=True)}


def _remembers(
    known: TimeResiduals, subsets: tuple[str, ...], rng: np.random.Generator
) -> tuple[Finding | None, dict[str, Any]]:
    """Whether residuals depend on the commands before, or on their neighbour in time."""
    left, pairs = known.without_zeros(), known.pairs()
    raw, within = lag_one(known.residuals, pairs), lag_one(left, pairs)
    local = left - left[_neighbours_of(known)].mean(axis=1)
    before = np.hstack([known.step, known.stops])
    before = (before - before.mean(axis=0)) / np.where(before.std(axis=0) > 0, before.std(axis=0), 1.0)
    basis = np.linalg.svd(before, full_matrices=False)[0]
    local = (local - local.mean(axis=0)) / np.where(local.std(axis=0) > 0, local.std(axis=0), 1.0)
    n_rows = len(local)
    # Of so many directions of memory, chance explains this share of the variance.
    chance = basis.shape[1] / n_rows

    def explained(rows: Array) -> Array:
        return np.asarray(np.square(basis.T @ rows).sum(axis=0) / n_rows - chance)

    def statistic(rows: Any) -> float:
        return float(max(explained(local[rows]).max(), lag_one(local[rows], pairs).max()))

    observed = statistic(np.arange(n_rows))
    p_value = _p_value(statistic, observed, lambda: rng.permutation(n_rows))
    share = np.maximum(explained(local), lag_one(local, pairs)).clip(min=0)
    effect = np.sqrt(share) * left.std(axis=0)
    numbers = {
        "remembers": {
            "effect_mm": _by_coordinate(known.names, effect),
            "lag_one": _by_coordinate(known.names, raw),
            "lag_one_within_sessions": _by_coordinate(known.names, within),
            "p_value": p_value,
        }
    }
    if observed < LARGE_MEMORY or p_value > CHANCE:
        return None, numbers
    worst = int(np.argmax(effect))
    return (
        Finding(
            "remembers",
            WARNING,
            subsets,
            f"The robot remembers: where it goes depends on the commands before, by {effect[worst]:.2g} mm in "
            f"{known.names[worst]} (standard deviation; p = {p_value:.3g}). Residuals correlate with those of the next "
            f"pose at {raw[worst]:.2f}, within a session at {within[worst]:.2f}.",
            "No model of the command alone errs by less. Choose a model with memory, and split the recording by time.",
        ),
        numbers,
    )


def _neighbours_of(known: TimeResiduals) -> Any:
    """Rows (n_rows, N_NEIGHBOURS) nearest in command space, the row itself left out."""
    from sklearn.neighbors import NearestNeighbors

    scaled = known.commands / command_scale(known.commands)
    near = NearestNeighbors(n_neighbors=min(N_NEIGHBOURS + 1, len(scaled))).fit(scaled)
    return near.kneighbors(scaled, return_distance=False)[:, 1:]


def _sessions_differ(
    known: TimeResiduals, subsets: tuple[str, ...], rng: np.random.Generator
) -> tuple[Finding | None, dict[str, Any]]:
    """Whether zeros differ; long stretches of the recording are permuted, so that memory alone does not count."""
    numbers_of = np.unique(known.session)
    if len(numbers_of) < 2:
        return None, {"sessions_differ": {"not_measured": "one session"}}
    scatter = known.without_zeros().std(axis=0)
    codes = np.searchsorted(numbers_of, known.session)
    counts = np.bincount(codes)
    large = counts >= min(SMALL_SESSION, counts.max())

    def zeros(rows: Any) -> Array:
        sums = np.stack([np.bincount(codes, known.residuals[rows, place]) for place in range(len(scatter))], axis=1)
        return np.asarray((sums / counts[:, None])[large])

    def statistic(rows: Any) -> float:
        return float((np.ptp(zeros(rows), axis=0) / np.where(scatter > 0, scatter, 1.0)).max())

    n_rows = len(codes)
    n_stretches = max(4, n_rows // STRETCH)
    stretches = np.array_split(np.arange(n_rows), n_stretches)
    observed = statistic(np.arange(n_rows))
    p_value = _p_value(
        statistic, observed, lambda: np.concatenate([stretches[place] for place in rng.permutation(n_stretches)])
    )
    shift = np.ptp(zeros(np.arange(n_rows)), axis=0)
    numbers = {
        "sessions_differ": {
            "zero_mm": {
                str(number): _by_coordinate(known.names, zero)
                for number, zero in zip(numbers_of, known.zeros(), strict=True)
            },
            "effect_mm": _by_coordinate(known.names, shift),
            "p_value": p_value,
        }
    }
    if observed < LARGE_ZERO or p_value > CHANCE:
        return None, numbers
    worst = int(np.argmax(shift))
    return (
        Finding(
            "sessions_differ",
            WARNING,
            subsets,
            f"Each time the robot is switched on its zero is somewhere else: the means of {len(numbers_of)} sessions "
            f"differ by up to {shift[worst]:.2g} mm in {known.names[worst]} (p = {p_value:.3g}).",
            "Intervals calibrated in one session do not hold in the next. Recalibrate on a few poses of each new one.",
        ),
        numbers,
    )


def _drifts(
    known: TimeResiduals, subsets: tuple[str, ...], rng: np.random.Generator
) -> tuple[Finding | None, dict[str, Any]]:
    """Whether residuals have a trend within a session; stretches of it are permuted, so that memory does not count."""
    scatter = known.without_zeros().std(axis=0)
    scatter = np.where(scatter > 0, scatter, 1.0)
    drift = np.zeros(len(scatter))
    p_values = []
    sessions = [np.flatnonzero(known.session == number) for number in np.unique(known.session)]
    for rows in (rows for rows in sessions if len(rows) >= 2 * SMALL_SESSION):
        residuals = known.residuals[rows]
        when = np.linspace(-0.5, 0.5, len(rows))
        weights = when / (when**2).sum()
        slopes = weights @ residuals
        drift = np.where(np.abs(slopes) > np.abs(drift), slopes, drift)
        stretches = np.array_split(np.arange(len(rows)), max(6, len(rows) // STRETCH))

        def statistic(turned: Any, residuals: Array = residuals, weights: Array = weights) -> float:
            return float((np.abs(weights @ residuals[turned]) / scatter).max())

        def draw(stretches: list[Any] = stretches) -> Any:
            return np.concatenate([stretches[place] for place in rng.permutation(len(stretches))])

        p_values.append(_p_value(statistic, statistic(np.arange(len(rows))), draw))
    if not p_values:
        return None, {"drifts": {"not_measured": "sessions are too short"}}
    p_value = min(1.0, len(p_values) * min(p_values))
    numbers = {"drifts": {"effect_mm": _by_coordinate(known.names, drift), "p_value": p_value}}
    if (np.abs(drift) / scatter).max() < LARGE_DRIFT or p_value > CHANCE * len(p_values):
        return None, numbers
    worst = int(np.argmax(np.abs(drift)))
    return (
        Finding(
            "drifts",
            WARNING,
            subsets,
            f"The robot drifts: within a session its poses move by {abs(drift[worst]):.2g} mm in {known.names[worst]} "
            f"(p = {p_value:.3g}).",
            "Later poses lie off. Split the recording with the method later, and recalibrate from time to time.",
        ),
        numbers,
    )


def _neighbours(samples: Mapping[str, Samples]) -> list[Finding]:
    """The subsets of which most rows have a row of `train` right before or after them."""
    train = samples[TRAIN].recording
    assert train is not None
    findings = []
    for subset in (VALIDATION, TEST):
        recording = samples[subset].recording
        assert recording is not None
        beside = np.isin(recording.order - 1, train.order) | np.isin(recording.order + 1, train.order)
        if beside.mean() > 0.5:
            findings.append(
                Finding(
                    NEIGHBOURS_IN_TIME,
                    WARNING,
                    (subset,),
                    f"{OPTIMISTIC}, beside {beside.mean():.0%} of the rows of {subset}.",
                    "Poses of a new recording will be farther off than these: see the splits by time.",
                )
            )
    return findings
