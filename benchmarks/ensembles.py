"""What ensembles are worth on rows that their weights were not picked on, beside the best run and means.

    python -m benchmarks.ensembles [--results results] [datasets ...]
    python -m benchmarks.ensembles --seeds 2 [--first-seed 2601] [--rows 400] [--core-shares 0.6 0.7 0.8 0.9]
    python -m benchmarks.ensembles --cores 0.6 0.7 0.85 [--results results] [datasets ...]

The first reads what the studies of a finished run of the default configuration have kept (`held_out.npz`). Each fold,
or shell, in turn is scored with weights that were picked on the others: the mean error over that of the best run, which
is picked the same way. Prints a line per dataset, preset and way of weighting, and the geometric mean over all.

The others search all models anew, with fewer trials, where the truth outside may be looked at: on simulated robots, as
they are and with noise of 1 % of their workspace on `train`; and on rows of `train` of a finished run, where a core by
command norm, less a tenth of its commands, takes the place of `train` and the shell around it that of extrapolation.
Printed are the mean absolute errors (mm) of the run that is deployed for both objectives, in-domain and outside, with
the ensembles of each way in the pool.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.files import read_json
from softkin.core.folds import grouped_folds
from softkin.core.narrowing import narrowed_configuration
from softkin.core.runs import BOTH, OUTER, SEARCHED, TUNED, Run
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array, Samples, informative_coordinates
from softkin.core.shells import command_norm, outer_shells
from softkin.data.split import has_standardised_norm
from softkin.data.standins import STANDINS
from softkin.data.standins.simulating import simulate
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.ensembles.spec import EnsembleSpec
from softkin.training.ensemble import Pool, Steps
from softkin.training.held_out import SCORES, PartSettings, Robot, parts_of, read_held_out, some_markers, truth_of
from softkin.training.kinematic_model import fitted_model, searched_settings
from softkin.training.members import Weights
from softkin.training.selection import OBJECTIVES
from softkin.training.study import TuningSettings
from softkin.training.tune import PresetFiles, SearchSettings, tune_table

N_TRIALS, N_FOLDS, MAX_ROWS, MAX_MARKERS = {TUNED: 12, OUTER: 8}, 5, 800, 2
SPACES = ("cartesian", "curvature")
Subsets = Mapping[str, Samples]


def plain(n_runs: int) -> EnsembleSpec:
    """The plain mean of the best runs."""

    def steps(predicted: Array, truth: Array, shares: Array) -> Array:
        best = np.argsort(np.abs(predicted - truth).mean(axis=2) @ shares, kind="stable")[:n_runs]
        return np.isin(np.arange(len(predicted)), best)[None] / len(best)

    return EnsembleSpec(name="mean", title="Mean", family="ensemble", steps=steps)


def halfway(predicted: Array, truth: Array, shares: Array) -> Array:
    """The steps of the configuration's ensemble, each halfway to equal weights of its members."""
    weights = ENSEMBLES["ensemble"].steps(predicted, truth, shares)
    return np.asarray((weights + (weights > 0) / (weights > 0).sum(axis=1, keepdims=True)) / 2)


class Relative(Pool):
    """Compares errors in units of what the best run errs on a part, where in mm those parts decide that are hard."""

    def steps(self, spec: EnsembleSpec, by: str, parts: Sequence[int]) -> Steps:
        """See `Pool`; its errors are in these units."""
        runs = [run for run, stored in self.predicted.items() if by in stored]
        units = [max(1e-9, min(self.error({run: 1.0}, by, part) for run in runs)) for part in parts]
        truth = {by: [self.truth[by][part] / unit for part, unit in zip(parts, units, strict=True)]}
        of_runs = {
            run: {by: np.concatenate([self.predicted[run][by][part] / u for part, u in zip(parts, units, strict=True)])}
            for run in runs
        }
        return Pool(truth, of_runs).steps(spec, by, range(len(parts)))


#: Title -> how errors are compared, and how runs are weighted; the last is that of the configuration.
WAYS: dict[str, tuple[type[Pool], EnsembleSpec]] = {
    **{title: (Pool, plain(n)) for n, title in ((1, "best run"), (3, "mean of 3"), (5, "mean of 5"))},
    "halfway": (Pool, replace(ENSEMBLES["ensemble"], steps=halfway)),
    "relative": (Relative, ENSEMBLES["ensemble"]),
    "ensemble": (Pool, ENSEMBLES["ensemble"]),
}


def configuration_of(results: Path) -> dict[str, Any]:
    """That of a finished run."""
    return dict(read_json(results / "tables" / "summary.json")["configuration"])


def held_out_of(results: Path, dataset: str) -> tuple[dict[str, list[Array]], dict[Run, dict[str, Array]]]:
    """True positions of held-out rows by preset and part, and what each searched run of a dataset predicts of them."""
    config = narrowed_configuration(configuration_of(results), dataset)
    tuning = {name: config["tuning"][name] for name in ("n_folds", "core_shares", "max_rows", "max_markers")}
    settings = PartSettings(**tuning, scores=SEARCHED, seed=config["seed"])
    table = results / dataset / "table.parquet"
    rows, parts = parts_of(read_subset(table, TRAIN), settings, robot_of(config["sources"][dataset]))
    runs = [Run(model, preset) for model in config["models"] for preset in SEARCHED if preset in config["presets"]]
    predicted = {run: read_held_out(results / dataset / run.model / run.preset / "held_out.npz") for run in runs}
    return {by: truth_of(rows, of_preset) for by, of_preset in parts.items()}, predicted


def robot_of(source: Mapping[str, Any]) -> Robot:
    """Of the entry of a dataset."""
    return Robot(source.get("base"), has_standardised_norm(source))


def left_out(results: Path, datasets: Sequence[str]) -> pd.DataFrame:
    """Errors on parts of `train` left out, a row per dataset and preset."""
    table = {}
    for dataset in datasets:
        stored = held_out_of(results, dataset)
        for by in SEARCHED:
            table[dataset, by] = {title: of(*stored).left_out_score(way, by) for title, (of, way) in WAYS.items()}
    return pd.DataFrame(table).T


def simulated(n_rows: int, seed: int) -> Iterator[tuple[str, Subsets, Robot]]:
    """Name, subsets and robot: every stand-in, its sessions unknown, and with noise on `train` where it has none."""
    robot = Robot(None, standardised_norm=False)
    for name in STANDINS:
        rows = simulate(name, n_rows=n_rows, seed=seed)
        subsets = {key: some_markers(Samples(of.commands, of.positions), MAX_MARKERS) for key, of in rows.items()}
        yield f"{name} {seed}", subsets, robot
        if name in ("pneumatic_arm", "tendon_finger"):
            train, rng = subsets[TRAIN], np.random.default_rng([seed, 7])
            noise = 0.01 * np.ptp(train.positions, axis=0) * rng.standard_normal(train.positions.shape)
            noisy = Samples(train.commands, train.positions + noise)
            yield f"{name} with noise {seed}", {**subsets, TRAIN: noisy}, robot


def cores(results: Path, datasets: Sequence[str], shares: Sequence[float]) -> Iterator[tuple[str, Subsets, Robot]]:
    """Name, subsets and robot: cores of `train`, of whose commands a tenth is in-domain, and the shells around them."""
    for dataset, share in itertools.product(datasets, shares):
        train = read_subset(results / dataset / "table.parquet", TRAIN)
        robot = robot_of(configuration_of(results)["sources"][dataset])
        rows = some_markers(Samples(train.commands, train.positions), MAX_MARKERS)
        norms = command_norm(rows.commands, standardised=robot.standardised_norm).of(rows.commands)
        core, shell = outer_shells(norms, [share])[0]
        fitted, new = (core[part] for part in grouped_folds(rows.commands[core], 10, 0)[0])
        subsets = {TRAIN: rows.take(fitted), TEST: rows.take(new), EXTRAPOLATION: rows.take(shell)}
        yield f"{dataset} {share}", subsets, robot


def searched(subsets: Subsets, robot: Robot, core_shares: Sequence[float]) -> tuple[Any, Any, Any]:
    """Truth and predictions of the pool of all models' runs on `train`, and what each run errs on the other subsets."""
    train = subsets[TRAIN]
    moving = informative_coordinates(train.positions)
    rows, parts = parts_of(train, PartSettings(N_FOLDS, core_shares, MAX_ROWS, MAX_MARKERS, SEARCHED, 0), robot)
    held_out, errors = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "table.parquet"
        write_table(to_table({TRAIN: train}), table)
        for name, spec in MODELS.items():
            places = {preset: [Path(folder) / name / preset / file for file in "abcd"] for preset in SEARCHED}
            tune_table(
                table,
                spec=spec,
                robot=robot,
                settings=TuningSettings(N_TRIALS[TUNED], N_FOLDS, MAX_ROWS, 0),
                search=SearchSettings(N_TRIALS, SEARCHED, MAX_MARKERS, core_shares, SPACES),
                files={preset: PresetFiles(*of_preset) for preset, of_preset in places.items()},
                code="",
                threads=1,
            )
            for preset, (_, parameters, _, stored) in places.items():
                run = Run(name, preset)
                held_out[run] = read_held_out(stored)
                model = fitted_model(spec, searched_settings(read_json(parameters), robot.base, 0, 1), train)
                new = {key: subsets[key] for key in (TEST, EXTRAPOLATION)}
                errors[run] = {key: (model.predict(of.inputs) - of.positions)[:, moving] for key, of in new.items()}
    return {by: truth_of(rows, of_preset) for by, of_preset in parts.items()}, held_out, errors


def deployed(pool: Pool, way: EnsembleSpec) -> Weights:
    """The run that is deployed for both objectives, where the ensembles of one way are in the pool."""
    runs: list[tuple[Weights, dict[str, float]]] = [
        ({run: 1.0}, {SCORES[by]: pool.score({run: 1.0}, by) for by in SEARCHED}) for run in pool.predicted
    ]
    for preset in SEARCHED:
        best = pool.steps(way, preset, range(len(pool.truth[preset]))).best
        own = {preset: pool.left_out_score(way, preset)}
        runs.append((best, {SCORES[by]: own[by] if by in own else pool.score(best, by) for by in SEARCHED}))
    return runs[int(np.argmin(OBJECTIVES[BOTH](pd.DataFrame([scores for _, scores in runs]))))][0]


def outside(cases: Iterator[tuple[str, Subsets, Robot]], core_shares: Sequence[float]) -> pd.DataFrame:
    """Errors (mm) of the deployed run in-domain and outside, a row each per case."""
    table: dict[tuple[str, str], dict[str, float]] = {}
    for name, subsets, robot in cases:
        *stored, errors = searched(subsets, robot, core_shares)
        for title, (of, way) in WAYS.items():
            weights = deployed(of(*stored), way)
            for subset in (TEST, EXTRAPOLATION):
                mean = sum(weight * errors[run][subset] for run, weight in weights.items())
                table.setdefault((subset, name), {})[title] = float(np.abs(mean).mean())
    return pd.DataFrame(table).T.sort_index(kind="stable")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--seeds", type=int, default=0)
    parser.add_argument("--first-seed", type=int, default=2601)
    parser.add_argument("--rows", type=int, default=400)
    parser.add_argument("--cores", type=float, nargs="*", default=[])
    parser.add_argument("--core-shares", type=float, nargs="+", default=(0.5, 0.7, 0.85), help="of studies of `outer`")
    parser.add_argument("datasets", nargs="*")
    arguments = parser.parse_args()
    warnings.filterwarnings("ignore")
    logging.disable(logging.CRITICAL)
    datasets = arguments.datasets or ([] if arguments.seeds else configuration_of(arguments.results)["datasets"])
    if not arguments.seeds and not arguments.cores:
        show(left_out(arguments.results, datasets), "best run")
        return
    cases = cores(arguments.results, datasets, arguments.cores)
    if arguments.seeds:
        seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
        cases = (case for seed in seeds for case in simulated(arguments.rows, seed))
    errors = outside(cases, arguments.core_shares)
    print(errors.map("{:.4g}".format).to_string())
    for subset, of_subset in errors.groupby(level=0, sort=False):
        print(f"\n{subset}, over those with the ensembles of the configuration")
        show(of_subset, "ensemble")


def show(errors: pd.DataFrame, beside: str) -> None:
    """Print errors over those of one way, and the geometric means."""
    ratios = errors.div(errors[beside], axis=0)
    ratios.loc[("geometric mean", ""), :] = np.exp(np.log(ratios).mean())
    print(ratios.round(3).to_string())


if __name__ == "__main__":
    main()
