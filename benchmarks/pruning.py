"""CPU time and best score of studies that prune trials, by the share of trials that are kept.

    python benchmarks/pruning.py [--dataset finger] [--models svr gp] [--kept 100 50 10]
    python benchmarks/pruning.py --rung results

Runs the study of the preset `tuned` of each model, as config/config.yaml has it, on a dataset of a finished run: once
for each share `--kept` (percent) of the complete trials that a trial must be among to go on; 100 prunes none. Prints
the pruned trials, the CPU seconds and the best score (mm).

`--rung` reads the trials of a finished run instead, and prints what a first rung could save: scores on a quarter of the
rows of the first part, before that part is scored whole. Trials that end after the first part would end there, at a
quarter of their cost; all others would pay that quarter in addition.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from unittest.mock import patch

import pandas as pd
import yaml

from softkin.core.runs import TUNED
from softkin.core.samples import TRAIN
from softkin.data.split import has_standardised_norm
from softkin.data.table import read_subset
from softkin.models import MODELS
from softkin.training.held_out import Robot
from softkin.training.study import KEPT_PERCENT, StudyFile, TuningSettings
from softkin.training.tune import SearchSettings, held_out_rows, tune_model

HOUSE = Path(__file__).parent.parent
#: Share of the rows of a first rung.
RUNG = 0.25


def main() -> None:
    """Tune, and print a line per model and share."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--dataset", default="finger")
    parser.add_argument("--models", nargs="+", default=list(MODELS), choices=list(MODELS))
    parser.add_argument("--kept", nargs="+", type=float, default=[100.0, 50.0, KEPT_PERCENT])
    parser.add_argument("--rung", type=Path, help="results of a finished run")
    arguments = parser.parse_args()
    if arguments.rung is not None:
        print(rung(arguments.rung))
        return
    config = yaml.safe_load((HOUSE / "config" / "config.yaml").read_text())
    tuning, seed = config["tuning"], config["seed"]
    source = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"][arguments.dataset]
    train = read_subset(HOUSE / "results" / arguments.dataset / "table.parquet", TRAIN)
    print(f"{'model':<7}{'kept %':>7}{'pruned':>8}{'CPU s':>8}{'best mm':>11}")
    for model in arguments.models:
        for kept in arguments.kept:
            with tempfile.TemporaryDirectory() as folder, patch("softkin.training.study.KEPT_PERCENT", kept):
                settings = TuningSettings(tuning["n_trials"], tuning["n_folds"], tuning["max_rows"], seed)
                search = SearchSettings(
                    {TUNED: tuning["n_trials"]}, [TUNED], tuning["max_markers"], [], config["target_spaces"]
                )
                robot = Robot(base=source.get("base"), standardised_norm=has_standardised_norm(source))
                held_out = held_out_rows(
                    train, spec=MODELS[model], robot=robot, settings=settings, search=search, threads=1
                )
                result = tune_model(
                    train,
                    held_out=held_out,
                    preset=TUNED,
                    settings=settings,
                    search=search,
                    file=StudyFile(Path(folder) / "study.journal", ""),
                )
            pruned = (result.trials["state"] == "PRUNED").sum()
            cpu = result.trials["cpu_seconds"].sum()
            print(f"{model:<7}{kept:>7g}{pruned:>8}{cpu:>8.1f}{result.score_mm:>11.5f}", flush=True)


def rung(results: Path) -> str:
    """What a first rung could save at most over all studies of point models, in CPU seconds."""
    read = [pd.read_csv(path) for path in sorted(results.glob("*/*/*/trials.csv"))]
    trials = pd.concat([one for one in read if "n_parts_scored" in one])
    first = trials["cpu_seconds"] / trials["n_parts_scored"].clip(lower=1)
    ends = trials["n_parts_scored"] <= 1
    saved, paid = (1 - RUNG) * first[ends].sum(), RUNG * first[~ends].sum()
    return (
        f"{len(trials)} trials take {trials['cpu_seconds'].sum():.0f} s of CPU; "
        f"{ends.sum()} end after their first part, and take {first[ends].sum():.0f} s. "
        f"A rung of {RUNG:.0%} of the rows saves at most {saved:.0f} s of these, and costs the others {paid:.0f} s."
    )


if __name__ == "__main__":
    main()
