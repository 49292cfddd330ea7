"""Do intervals cover hard commands as often as easy ones? On simulated robots, by what their width is proportional to.

    python -m benchmarks.difficulty [--seeds 4] [--first-seed 2026] [--rows 400] [--results results]

Simulates every memoryless stand-in with errors of four kinds: none but the model's own; noise that is the same
everywhere; that grows tenfold from one end of the first command to the other; that grows tenfold with the command norm.
Around Huber's regression and a Gaussian process, in-domain, split conformal intervals at 90 % have one width, or one
proportional to the distance, to the model's spread, or to held-out errors near by. Printed are, by noise and method:
coverage, and by quintile of the norm and of the width, means over cases; the share of quintiles, a case and coordinate
each, within the exact band that one of all rows has with 95 %; width and Winkler score beside those of one width, their
typical ratios; and how often the method is the one that `choose` would take. With `--results`, a finished run, no robot
is simulated: the errors of its deployed runs on held-out folds of `train` are split 30 times, 60 % for the difficulty,
15 % to calibrate, 25 % to score, and no other row is read.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import time
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from optuna.trial import FixedTrial

from benchmarks.choice import INSIDE, LEVEL, data_of, simulated, uneven
from benchmarks.finished_studies import record_of, studies_of
from softkin.core.folds import folds_of
from softkin.core.metrics.interval import coverage_band, covered, typical_winkler, widths, winkler_scores
from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, VALIDATION, Array, Samples
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibration_data import HeldOutCalibration, PointCalibration
from softkin.uncertainty.choose import deployed_choice, held_out_scores
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.held_out_difficulty import fit_difficulty
from softkin.uncertainty.held_out_errors import held_out_errors
from softkin.uncertainty.intervals import INTERVAL_METHODS

N_FOLDS, N_BINS = 5, 5
METHODS = ("scp_mapie", "scp_distance", "scp_spread", "scp_held_out")


def noise(samples: Samples, kind: str, seed: int) -> Array:
    """The positions with noise of a kind."""
    rng, extent = np.random.default_rng([seed, 2]), np.ptp(samples.positions, axis=0)
    if kind == "none":
        return samples.positions
    if kind == "along a command":
        return uneven(samples, rng)[0]
    norms = np.linalg.norm(samples.commands - samples.commands.mean(axis=0), axis=1)
    factor = 10 ** (np.argsort(np.argsort(norms)) / len(norms)) if kind == "with the norm" else np.full(len(norms), 5.0)
    return np.asarray(
        samples.positions + 0.002 * extent * factor[:, None] * rng.standard_normal(samples.positions.shape)
    )


KINDS = ("none", "even", "along a command", "with the norm")


def held_out_data(subsets: Mapping[str, Samples], model: str, points: PointCalibration) -> tuple[Any, float]:
    """Calibration data with the difficulty by errors on held-out folds of train, and CPU seconds that it took."""
    train, spec = subsets[TRAIN], MODELS[model]
    settings = FitSettings(spec.search_space(FixedTrial(dict(spec.first_trials[0]))), True, 0, 1)
    errors = np.empty_like(train.positions)
    for fitted, scored in folds_of(train, N_FOLDS, 0):
        estimator = fitted_model(spec, settings, train.take(fitted))
        errors[scored] = np.abs(train.positions[scored] - estimator.predict(train.commands[scored]))
    start = time.process_time()
    difficulty = fit_difficulty(train.commands, errors, np.arange(train.positions.shape[1]))
    return HeldOutCalibration(**vars(points), difficulty=difficulty), time.process_time() - start


def cases(samples: Samples, cuts: list[int], kind: str, seed: int) -> Iterator[dict[str, Any]]:
    """A row per point model and method."""
    positions = noise(samples, kind, seed)
    parts = zip(INSIDE, np.split(samples.commands, cuts), np.split(positions, cuts), strict=True)
    subsets = {name: Samples(c, p) for name, c, p in parts}
    truth, n = subsets[TEST].positions, len(subsets[VALIDATION])
    for model in ("huber", "gp"):
        data = {name: of for name, of in data_of(subsets, model).items() if name in METHODS}
        data["scp_held_out"], seconds = held_out_data(subsets, model, data["scp_mapie"])
        scores: dict[str, float] = {}
        rows = []
        for name, of in data.items():
            method = INTERVAL_METHODS[name]
            moving = np.ones(truth.shape[1], dtype=bool)
            scores[name] = typical_winkler(held_out_scores(method, of, [LEVEL], moving, 0)[0])
            bounds = method.intervals(of, [LEVEL])[0]
            row = {"noise": kind, "model": model, "method": name, "seconds": seconds}
            rows.append(row | scored(bounds, truth, subsets[TEST].commands, n))
        best = min(scores, key=scores.__getitem__)
        yield from with_ratios([row | {"taken": row["method"] == best} for row in rows])


def scored(bounds: Array, truth: Array, commands: Array, n_calibration: int) -> dict[str, Any]:
    """Coverage, all in all and by quintile, width and scores of bounds (n_rows, n_coordinates, 2)."""
    rank = conformal_rank(n_calibration, LEVEL)
    assert rank is not None
    inside, wide, in_band = covered(truth, bounds), widths(bounds), []
    row: dict[str, Any] = {"coverage": inside.mean()}
    for by, values in (("norm", np.linalg.norm(commands, axis=1)), ("width", wide.mean(axis=1))):
        bins = np.array_split(np.argsort(values, kind="stable"), N_BINS)
        row |= {f"{by} {place + 1}": inside[group].mean() for place, group in enumerate(bins)}
        for group in bins if by == "norm" or np.ptp(values) > 0 else []:
            low, high = coverage_band(len(group), n_calibration, rank)
            in_band += [low <= share <= high for share in inside[group].mean(axis=0)]
    winkler = winkler_scores(truth, bounds, LEVEL)
    row |= {"in band": np.mean(in_band), "width": wide.mean(), "winkler": winkler.mean()}
    return row | {"typical": typical_winkler(winkler.mean(axis=1))}


def with_ratios(rows: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The rows, with ratios to the first, whose intervals have one width."""
    for row in rows:
        yield row | {f"{key} ratio": row[key] / rows[0][key] for key in ("width", "winkler", "typical")}


def inner_splits(folder: Path) -> Iterator[dict[str, Any]]:
    """A row per split of the held-out errors of a dataset's deployed run, and method."""
    choice = deployed_choice(folder / "interval_choice.csv")
    assert choice is not None
    run = Run(choice["model"], choice["preset"])
    commands, errors = held_out_errors(*studies_of(folder), {run: record_of(folder, run)})[run]
    n = len(commands)
    for seed in range(30):
        fitted, known, new = np.split(np.random.default_rng(seed).permutation(n), [int(0.6 * n), int(0.75 * n)])
        places = [commands[rows] for rows in (fitted, known, new)]
        zeros = [np.zeros_like(errors[rows]) for rows in (known, new)]
        data = PointCalibration(zeros[0], errors[known], zeros[1], *places)
        difficulty = fit_difficulty(places[0], errors[fitted], np.arange(errors.shape[1]))
        of = dict.fromkeys(METHODS[:2], data) | {
            "scp_held_out": HeldOutCalibration(**vars(data), difficulty=difficulty)
        }
        rows = [
            {"noise": folder.name, "method": name, "seconds": 0.0, "taken": np.nan}
            | scored(INTERVAL_METHODS[name].intervals(one, [LEVEL])[0], errors[new], places[2], len(known))
            for name, one in of.items()
        ]
        yield from with_ratios(rows)


def main() -> None:
    """Print a line per noise and method."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--first-seed", type=int, default=2026)
    parser.add_argument("--rows", type=int, default=400)
    parser.add_argument("--results", type=Path)
    arguments = parser.parse_args()
    warnings.filterwarnings("ignore")
    logging.disable(logging.CRITICAL)
    robots = [name for name, standin in STANDINS.items() if not standin.sessions]
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    found: list[dict[str, Any]] = []
    if arguments.results is not None:
        folders = sorted(path.parent for path in arguments.results.glob("*/table.parquet"))
        found = [row for folder in folders for row in inner_splits(folder)]
        robots = []
    for robot, seed in itertools.product(robots, seeds):
        samples, cuts = simulated(robot, arguments.rows, seed)
        found += [row for kind in KINDS for row in cases(samples, cuts, kind, seed)]
    frame = pd.DataFrame(found)
    print(f"{'noise':<17}{'method':<14}{'cases':>5}{'covered':>9}  {'quintiles of norm':<27}{'of width':<27}", end="")
    print(f"{'in band':>8}{'width':>7}{'winkler':>9}{'typical':>9}{'taken':>7}")
    for (kind, name), of in frame.groupby(["noise", "method"], sort=False):
        by = {
            key: " ".join(f"{of[f'{key} {place + 1}'].mean():.2f}" for place in range(N_BINS))
            for key in ("norm", "width")
        }
        ratios = [float(np.exp(np.log(of[f"{key} ratio"]).mean())) for key in ("width", "winkler", "typical")]
        print(
            f"{kind:<17}{name:<14}{len(of):>5}{of['coverage'].mean():>9.3f}  {by['norm']:<27}{by['width']:<27}", end=""
        )
        print(
            f"{of['in band'].mean():>8.0%}{ratios[0]:>7.2f}{ratios[1]:>9.3f}{ratios[2]:>9.3f}{of['taken'].mean():>7.0%}"
        )
    print(f"fitting a difficulty took {frame['seconds'].mean():.3f} s of CPU time, {arguments.rows} held-out rows")


if __name__ == "__main__":
    main()
