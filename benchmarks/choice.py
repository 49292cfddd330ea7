"""Which score picks the interval method that serves the rows that are no gross errors? On simulated robots.

    python -m benchmarks.choice [--seeds 8] [--first-seed 500] [--rows 400]

Simulates every memoryless stand-in, seed by seed, and spoils its rows in several ways. The candidates are those of a
run: split conformal prediction by four methods around one point model (Huber's regression or a Gaussian process), and
CQR on XGBoost. Each score picks one on `validation`, as `softkin.uncertainty.choose` does. Printed are, by what is
wrong with the rows and by score: the mean Winkler score of the pick on new rows that are no gross errors, over that of
the best candidate there (the geometric mean over cases, and the worst case); the same with all rows counted; how often
the pick is another one than on the same robot unspoilt; and, in the worst case, the mean Winkler score of the pick over
that of the best candidate on validation without the five rows that speak most for it.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from optuna.trial import FixedTrial

from softkin.core.metrics.interval import typical_winkler, winkler_scores
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, VALIDATION, Array, Samples
from softkin.data.audit.gross_rows import gross_rows
from softkin.data.standins import STANDINS
from softkin.data.standins.simulating import simulate
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.fit_quantiles import QuantileModel
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.predict import spread_of
from softkin.uncertainty.calibration_data import PointCalibration, PredictiveCalibration, QuantileCalibration
from softkin.uncertainty.choose import held_out_scores
from softkin.uncertainty.intervals import INTERVAL_METHODS

LEVEL, HANDFUL = 0.9, 5
POINT_MODELS = ("huber", "gp")
AROUND = ("scp_mapie", "scp_distance", "scp_spread", "cps")
#: Score of a candidate, from those of validation rows and the mask of its gross rows.
SCORES: dict[str, Callable[[Array, NDArray[np.bool_]], float]] = {
    "mean": lambda rows, _: float(rows.mean()),
    "gross apart": lambda rows, gross: float(rows[~gross].mean()),
    "logarithm": lambda rows, _: typical_winkler(rows),
    "both": lambda rows, gross: typical_winkler(rows[~gross]),
}
INSIDE = (TRAIN, VALIDATION, TEST)
Fault = Callable[[Samples, np.random.Generator], tuple[Array, NDArray[np.bool_]]]


def stuck(samples: Samples, rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
    """One row in a hundred stays in the pose of another."""
    bad = rng.random(len(samples)) < 0.01
    positions = samples.positions.copy()
    positions[bad] = samples.positions[rng.integers(len(samples), size=bad.sum())]
    return positions, bad


def slab(size: float, share: float = 1.0) -> Fault:
    """In a thin slab of commands (`share` times 1.5 % of the rows) three quarters of the rows are off by `size` of the
    extent.
    """

    def spoil(samples: Samples, rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
        along = samples.commands[:, 0]
        low, high = np.quantile(along, [0.6, 0.6 + 0.015 * share])
        bad = (along >= low) & (along <= high) & (rng.random(len(samples)) < 0.75)
        direction = np.random.default_rng(0).standard_normal(samples.positions.shape[1])
        return samples.positions + size * np.ptp(samples.positions, axis=0) * direction * bad[:, None], bad

    return spoil


def lost(samples: Samples, rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
    """One row in a hundred has a marker that was lost: anywhere in the workspace."""
    bad = rng.random(len(samples)) < 0.01
    low, high = samples.positions.min(axis=0), samples.positions.max(axis=0)
    return np.where(bad[:, None], rng.uniform(low, high, samples.positions.shape), samples.positions), bad


def tails(samples: Samples, rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
    """Noise of 0.3 % of the extent by Student's t with three degrees of freedom: no row is a gross error."""
    noise = 0.003 * np.ptp(samples.positions, axis=0) * rng.standard_t(3, samples.positions.shape)
    return samples.positions + noise, np.zeros(len(samples), dtype=bool)


def uneven(samples: Samples, rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
    """Noise that grows tenfold from one end of the first command to the other: no row is a gross error."""
    along = np.argsort(np.argsort(samples.commands[:, 0])) / len(samples)
    noise = 0.002 * np.ptp(samples.positions, axis=0) * 10 ** along[:, None]
    return samples.positions + noise * rng.standard_normal(samples.positions.shape), np.zeros(len(samples), dtype=bool)


def nothing(samples: Samples, _: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
    """The robot as it is."""
    return samples.positions, np.zeros(len(samples), dtype=bool)


FAULTS: dict[str, Fault] = {
    "none": nothing,
    "noise with tails": tails,
    "uneven noise": uneven,
    "stuck, 1 %": stuck,
    "lost, 1 %": lost,
    "slab, 30 % off": slab(0.3),
    "slab, 0.5 % off": slab(0.005),
    "broad slab, 30 %": slab(0.3, 3.0),
    "broad slab, 0.5 %": slab(0.005, 3.0),
}


def simulated(robot: str, n_rows: int, seed: int) -> tuple[Samples, list[int]]:
    """In-domain rows of the last marker of a stand-in, and where validation and test begin: as many in test as in
    train, a quarter as many in validation.
    """
    sizes = {TRAIN: n_rows, VALIDATION: n_rows // 4, TEST: n_rows, EXTRAPOLATION: n_rows // 4}
    subsets = simulate(robot, n_rows=sizes, seed=seed)
    parts = [subsets[name] for name in INSIDE]
    commands = np.concatenate([part.commands for part in parts])
    positions = np.concatenate([part.positions[:, -3:] for part in parts])
    return Samples(commands, positions), [n_rows, n_rows + n_rows // 4]


def data_of(subsets: Mapping[str, Samples], model: str) -> dict[str, Any]:
    """Calibration data of the methods around a point model."""
    train, validation, test = (subsets[name] for name in INSIDE)
    spec = MODELS[model]
    params = spec.search_space(FixedTrial(dict(spec.first_trials[0])))
    fitted = fitted_model(spec, FitSettings(params, skip_constant=True, seed=0, threads=1), train)
    known = {"calibration": fitted.predict(validation.commands), "truth": validation.positions}
    known |= {"new": fitted.predict(test.commands), "train_commands": train.commands}
    known |= {"calibration_commands": validation.commands, "new_commands": test.commands}
    data: dict[str, Any] = {name: PointCalibration(**known) for name in AROUND[:2]}
    if spec.spread is not None:
        spread = [spread_of(spec, fitted, train, rows.commands) for rows in (train, validation, test)]
        known |= dict(zip(("train_spread", "calibration_spread", "new_spread"), spread, strict=True))
        data |= {name: PredictiveCalibration(**known) for name in AROUND[2:]}
    return data


def quantiles_of(subsets: Mapping[str, Samples]) -> QuantileCalibration:
    """Calibration data of CQR on XGBoost."""
    train, validation, test = (subsets[name] for name in INSIDE)
    spec = QUANTILE_MODELS["xgb"]
    params = spec.search_space(FixedTrial(dict(spec.first_trials[0])))
    fitted = QuantileModel(spec, params, [LEVEL], 0, 1).fit(train)
    known, new = (fitted.predict(rows.commands) for rows in (validation, test))
    return QuantileCalibration(known, validation.positions, new, [LEVEL])


def cases(samples: Samples, cuts: list[int], fault: str, seed: int) -> Iterator[dict[str, Any]]:
    """A row per point model and score: what it picks, and what the pick is worth."""
    positions, is_bad = FAULTS[fault](samples, np.random.default_rng([seed, 1]))
    parts = zip(INSIDE, np.split(samples.commands, cuts), np.split(positions, cuts), strict=True)
    subsets, bad = {name: Samples(c, p) for name, c, p in parts}, is_bad[cuts[1] :]
    gross = gross_rows({name: subsets[name] for name in (TRAIN, VALIDATION)})[VALIDATION]
    truth = subsets[TEST].positions
    moving = np.ones(truth.shape[1], dtype=bool)
    quantiles = quantiles_of(subsets)
    for model in POINT_MODELS:
        data = data_of(subsets, model) | {"cqr": quantiles}
        methods = {name: INTERVAL_METHODS[name] for name in data}
        held_out = {name: held_out_scores(methods[name], data[name], [LEVEL], moving, 0)[0] for name in data}
        new = {
            name: winkler_scores(truth, methods[name].intervals(data[name], [LEVEL])[0], LEVEL).mean(axis=1)
            for name in data
        }
        for score, of in SCORES.items():
            values = {name: of(rows, gross) for name, rows in held_out.items()}
            pick, rival = sorted(values, key=values.__getitem__)[:2]
            rest = np.argsort(held_out[pick] - held_out[rival])[HANDFUL:]
            worth = {
                "regular": {name: rows[~bad].mean() for name, rows in new.items()},
                "all": {name: rows.mean() for name, rows in new.items()},
                "without": {name: rows[rest].mean() for name, rows in held_out.items()},
            }
            key = {"model": model, "fault": fault, "seed": seed, "score": score, "pick": pick}
            yield key | {name: of_all[pick] / min(of_all.values()) for name, of_all in worth.items()}


def main() -> None:
    """Print a line per fault and score."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--first-seed", type=int, default=500)
    parser.add_argument("--rows", type=int, default=400)
    parser.add_argument("--faults", nargs="+", default=list(FAULTS), choices=list(FAULTS))
    arguments = parser.parse_args()
    warnings.filterwarnings("ignore")
    logging.disable(logging.CRITICAL)
    robots = [name for name, standin in STANDINS.items() if not standin.sessions]
    faults = [*dict.fromkeys(["none", *arguments.faults])]  # picks are compared with those of the unspoilt robot
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    rows = []
    for robot, seed in itertools.product(robots, seeds):
        samples, cuts = simulated(robot, arguments.rows, seed)
        rows += [{"robot": robot} | row for fault in faults for row in cases(samples, cuts, fault, seed)]
    frame = pd.DataFrame(rows)
    key = ["robot", "model", "seed", "score"]
    unspoilt = frame[frame["fault"] == "none"].set_index(key)["pick"]
    frame["other"] = frame["pick"].to_numpy() != unspoilt.reindex(pd.MultiIndex.from_frame(frame[key])).to_numpy()
    print(
        f"{'wrong':<18}{'score':<13}{'regular rows':>14}{'worst':>9}{'all rows':>10}{'other pick':>12}{'without 5':>11}"
    )
    for (fault, score), of in frame.groupby(["fault", "score"], sort=False):
        means = [float(np.exp(np.log(of[name]).mean())) for name in ("regular", "all")]
        rest = f"{of['other'].mean():>12.0%}{of['without'].max():>11.2f}"
        print(f"{fault:<18}{score:<13}{means[0]:>14.3f}{of['regular'].max():>9.2f}{means[1]:>10.3f}{rest}")
    print(f"{len(frame) // len(SCORES) // len(faults)} cases per line")


if __name__ == "__main__":
    main()
