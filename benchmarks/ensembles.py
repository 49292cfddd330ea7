"""What ensembles are worth on rows of `train` that their weights were not picked on, beside the best run and means.

    python benchmarks/ensembles.py [--results results] [datasets ...]

Reads what the studies of a finished run of the default configuration have kept (`held_out.npz`). Each fold, or shell,
in turn is scored with weights that were picked on the others: the mean error over that of the best run, which is picked
the same way. Prints a line per dataset, preset and way of weighting, and the geometric mean over all.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.files import read_json
from softkin.core.narrowing import narrowed_configuration
from softkin.core.runs import SEARCHED, Run
from softkin.core.samples import TRAIN, Array
from softkin.data.split import has_standardised_norm
from softkin.data.table import read_subset
from softkin.models.ensembles import ENSEMBLES
from softkin.models.ensembles.spec import EnsembleSpec
from softkin.training.ensemble import Pool
from softkin.training.held_out import PartSettings, Robot, parts_of, read_held_out, truth_of


def ranked(predicted: Array, truth: Array, shares: Array, n_runs: int) -> Array:
    """Weights (1, n_runs) of the plain mean of the best runs."""
    best = np.argsort(np.abs(predicted - truth).mean(axis=2) @ shares, kind="stable")[:n_runs]
    return np.isin(np.arange(len(predicted)), best)[None] / len(best)


def plain(n_runs: int) -> EnsembleSpec:
    """The plain mean of the best runs."""

    def steps(predicted: Array, truth: Array, shares: Array) -> Array:
        return ranked(predicted, truth, shares, n_runs)

    title = f"mean of {n_runs}" if n_runs > 1 else "best run"
    return EnsembleSpec(name=title, title=title, family="ensemble", steps=steps)


WAYS = (plain(1), plain(3), plain(5), *ENSEMBLES.values())


def configuration_of(results: Path) -> dict[str, Any]:
    """That of a finished run."""
    return dict(read_json(results / "tables" / "summary.json")["configuration"])


def held_out_of(results: Path, dataset: str) -> tuple[dict[str, list[Array]], dict[Run, dict[str, Array]]]:
    """True positions of held-out rows by preset and part, and what each searched run of a dataset predicts of them."""
    config = narrowed_configuration(configuration_of(results), dataset)
    source = config["sources"][dataset]
    tuning = {name: config["tuning"][name] for name in ("n_folds", "core_shares", "max_rows", "max_markers")}
    settings = PartSettings(**tuning, scores=SEARCHED, seed=config["seed"])
    robot = Robot(source.get("base"), has_standardised_norm(source))
    rows, parts = parts_of(read_subset(results / dataset / "table.parquet", TRAIN), settings, robot)
    runs = [Run(model, preset) for model in config["models"] for preset in SEARCHED if preset in config["presets"]]
    predicted = {run: read_held_out(results / dataset / run.model / run.preset / "held_out.npz") for run in runs}
    return {by: truth_of(rows, of_preset) for by, of_preset in parts.items()}, predicted


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("datasets", nargs="*")
    arguments = parser.parse_args()
    table = {}
    for dataset in arguments.datasets or configuration_of(arguments.results)["datasets"]:
        pool = Pool(*held_out_of(arguments.results, dataset))
        for preset in SEARCHED:
            table[dataset, preset] = {way.title: pool.left_out_score(way, preset) for way in WAYS}
    frame = pd.DataFrame(table).T
    ratios = frame.div(frame["best run"], axis=0)
    ratios.loc[("geometric mean", ""), :] = np.exp(np.log(ratios).mean())
    print(ratios.round(3).to_string())


if __name__ == "__main__":
    main()
