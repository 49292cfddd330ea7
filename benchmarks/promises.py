"""Whether intervals keep what they promise on recordings: simulated robots with lag, backlash, drift and sessions.

python -m benchmarks.promises --draws 200

Each draw is a robot of two commands and one marker, a recording of 300 to 3,000 rows, a split by `time`, by `group` or
by `later`, and a robust polynomial of the command alone: what it misses is what the robot remembers. Printed is, for
each kind of split, how often 90 % is promised, the coverage of held-out blocks (mean over their rows and over draws) of
intervals that count rows and of those that count blocks, and the widths of the latter beside the former.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.linear_model import LinearRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures

from softkin.core.errors import DataError
from softkin.core.recording import CommandMemory, play
from softkin.core.samples import TEST, TRAIN, VALIDATION, Array, Samples
from softkin.data.blocks import blocks
from softkin.data.split import split
from softkin.uncertainty.conformal import conformal_limits
from softkin.uncertainty.promise import calibration_set

LEVEL = 0.9
#: The split that kinds and sizes are shown for: what softkin does where an entry says `time` and no more.
SHOWN = {"method": "time", "column": "t", "blocks": 100}
#: What a robot does besides what it is told, in the order in which it is drawn.
KINDS = ("backlash", "lag", "drift", "sessions")
#: Sizes of recordings that coverage is shown for, rows.
SIZES = ((300, 1200), (1200, 2100), (2100, 3001))
#: Of a recording: by what its poses differ from those of the command alone, in mm or as a share.
LAG, BACKLASH, DRIFT_MM, ZERO_MM, NOISE_MM = 0.9, 0.1, 4.0, 2.0, 0.2


def recording(n_rows: int, rng: np.random.Generator) -> tuple[Samples, NDArray[np.int64], list[str]]:
    """A trajectory of a robot that lags, has play, drifts and is switched off now and then; the trial of each row; and
    which of `KINDS` the robot is.

    Commands walk at random between -1 and 1, so that rows in turn are alike. Of lag, play, drift and sessions each is
    there in half of the robots.
    """
    has = rng.random(4) < 0.5
    steps = rng.normal(0, 0.15, (n_rows, 2))
    commands = np.empty((n_rows, 2))
    now = np.zeros(2)
    for row, step in enumerate(steps):
        now = now + step
        now = np.where(np.abs(now) > 1, np.sign(now) * 2 - now, now)
        commands[row] = now
    moved = play(commands, BACKLASH, np.zeros(2)) if has[0] else commands.copy()
    if has[1]:
        for row in range(1, n_rows):
            moved[row] = LAG * moved[row - 1] + (1 - LAG) * moved[row]
    first, second = moved.T
    poses = np.column_stack([40 * np.sin(first), 40 * np.sin(second), 100 - 10 * first**2 - 8 * second**2])
    poses += NOISE_MM * rng.standard_normal(poses.shape)
    n_trials = int(rng.integers(8, 40))
    trial = (np.arange(n_rows) * n_trials // n_rows).astype(np.int64)
    if has[2]:
        poses += DRIFT_MM * np.linspace(0, 1, n_rows)[:, None] * rng.standard_normal(3)
    if has[3]:
        poses += ZERO_MM * rng.standard_normal((n_trials, 3))[trial]
    order, session = np.arange(1, n_rows + 1), np.ones(n_rows, dtype=np.int64)
    memory = CommandMemory.of(commands).recorded(commands, order, session)
    return Samples(commands, poses, memory), trial, [kind for kind, is_it in zip(KINDS, has, strict=True) if is_it]


def draw(options: Mapping[str, Any], seed: int) -> dict[str, Any] | None:
    """Coverage and widths on one recording; None where it is too short for the split."""
    rng = np.random.default_rng(seed)
    rows, trial, kinds = recording(int(rng.integers(300, 3001)), rng)
    column = trial if options["method"] == "group" else np.arange(len(rows)).astype(float)
    options = {**options, "seed": seed} if options["method"] != "later" else options
    try:
        subset_of = split(options, rows.commands, column, str, rows.recording)
    except DataError:
        return None
    block = blocks(options, rows.commands, column, str)
    whole = Samples(rows.commands, rows.positions, rows.recording, block)
    parts = {
        name: whole.take(np.flatnonzero(subset_of == place)) for place, name in enumerate((TRAIN, VALIDATION, TEST))
    }
    model = make_pipeline(PolynomialFeatures(3), LinearRegression()).fit(parts[TRAIN].commands, parts[TRAIN].positions)
    errors = {name: np.abs(part.positions - model.predict(part.commands)) for name, part in parts.items()}
    calibration, numbers, promise = calibration_set(parts[VALIDATION])
    assert promise is not None
    assert len(calibration) == len(numbers)
    by_row = conformal_limits(errors[VALIDATION], [LEVEL])[0]
    by_block = conformal_limits(errors[VALIDATION][numbers], [promise.asked(LEVEL)])[0]
    return {
        "rows": len(rows),
        "kinds": kinds,
        "promised": promise.holds(LEVEL) and promise.n_blocks > 1,
        "blocks": promise.n_blocks,
        "by_row": _covered(errors[TEST], by_row, parts[TEST].block),
        "by_block": _covered(errors[TEST], by_block, parts[TEST].block),
        "width": float((by_block / by_row).mean()),
        "error": float(errors[TEST].mean()),
    }


def _covered(errors: Array, limits: Array, block: Any) -> float:
    """Share of rows within the limits, a mean over blocks."""
    inside = (errors <= limits).mean(axis=1)
    return float(np.mean([inside[block == number].mean() for number in np.unique(block)]))


def results(options: Mapping[str, Any], draws: int) -> Iterator[dict[str, Any]]:
    """Of each recording that can be split."""
    for seed in range(draws):
        if (found := draw(options, seed)) is not None:
            yield found


def by_kind(found: list[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """The recordings of each kind, with others and alone, and of each size, of those that are `found`."""
    groups = {f"with {kind}": [one for one in found if kind in one["kinds"]] for kind in KINDS}
    groups |= {f"{kind} alone": [one for one in found if one["kinds"] == [kind]] for kind in KINDS}
    groups["none of these"] = [one for one in found if not one["kinds"]]
    groups |= {f"{low} to {high - 1} rows": [one for one in found if low <= one["rows"] < high] for low, high in SIZES}
    return groups


def mean(found: list[dict[str, Any]], key: str) -> float:
    """Over recordings; NaN of none."""
    return float(np.mean([one[key] for one in found])) if found else float("nan")


def main() -> int:
    """Print a line per split, per kind of robot and per size; status 1 where promised intervals cover too little."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--least", type=float, default=0.88, help="coverage that promised intervals must have")
    arguments = parser.parse_args()
    splits: list[dict[str, Any]] = [{"method": "time", "column": "t", "blocks": n} for n in (50, 100, 200)]
    splits += [{"method": "group", "column": "trial"}, {"method": "later"}]
    worst, shown = 1.0, []
    print("split         recordings  promised  blocks  error mm", end="")
    print("   of promised: by row  by block  width  else: by row  by block")
    for options in splits:
        found = list(results(options, arguments.draws))
        kept, others = ([one for one in found if one["promised"] == is_it] for is_it in (True, False))
        name = f"{options['method']} {options.get('blocks', '')}"
        print(
            f"{name:<14}{len(found):>10}{len(kept) / len(found):>10.0%}{mean(found, 'blocks'):>8.1f}"
            f"{mean(found, 'error'):>10.2f}{mean(kept, 'by_row'):>22.1%}{mean(kept, 'by_block'):>10.1%}"
            f"{mean(kept, 'width'):>7.2f}{mean(others, 'by_row'):>14.1%}{mean(others, 'by_block'):>10.1%}",
            flush=True,
        )
        worst = min(worst, mean(kept, "by_block") if kept else 1.0)
        if options == SHOWN:
            shown = kept
    print(f"\n{SHOWN['method']} {SHOWN['blocks']}, promised    recordings   by row  by block")
    for name, of_kind in by_kind(shown).items():
        if of_kind:
            by_row, by_block = mean(of_kind, "by_row"), mean(of_kind, "by_block")
            print(f"{name:<22}{len(of_kind):>14}{by_row:>9.1%}{by_block:>10.1%}")
            worst = min(worst, by_block)
    return int(worst < arguments.least)


if __name__ == "__main__":
    raise SystemExit(main())
