"""CPU time and best score of studies that prune trials, by the share of trials that are kept.

    python benchmarks/pruning.py [--dataset finger] [--models svr gp] [--kept 100 50 10]

Runs the study of the preset `tuned` of each model, as config/config.yaml has it, on a dataset of a finished run: once
for each share `--kept` (percent) of the complete trials that a trial must be among to go on; 100 prunes none. Prints
the pruned trials, the CPU seconds and the best score (mm).
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from unittest.mock import patch

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


def main() -> None:
    """Tune, and print a line per model and share."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--dataset", default="finger")
    parser.add_argument("--models", nargs="+", default=list(MODELS), choices=list(MODELS))
    parser.add_argument("--kept", nargs="+", type=float, default=[100.0, 50.0, KEPT_PERCENT])
    arguments = parser.parse_args()
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


if __name__ == "__main__":
    main()
