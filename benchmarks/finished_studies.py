"""What studies of a finished run of the default configuration stored of held-out folds of `train`."""

from __future__ import annotations

from pathlib import Path

import yaml

from softkin.core.runs import TUNED, Run
from softkin.core.samples import TRAIN, Samples
from softkin.data.table import read_subset
from softkin.training.held_out import PartSettings

CONFIGURATION = Path(__file__).parents[1] / "config" / "config.yaml"


def studies_of(folder: Path) -> tuple[Samples, PartSettings, dict[Run, Path]]:
    """Of the results of a dataset: the rows of `train`, how studies drew parts of them, and run -> its file."""
    config = yaml.safe_load(CONFIGURATION.read_text(encoding="utf-8"))
    parts = {key: config["tuning"][key] for key in ("n_folds", "max_rows", "max_markers")}
    settings = PartSettings(**parts, core_shares=(), scores={TUNED}, seed=config["seed"])
    stored = {Run(*path.parts[-3:-1]): path for path in sorted(folder.glob("*/*/held_out.npz"))}
    return read_subset(folder / "table.parquet", TRAIN), settings, stored


def record_of(folder: Path, run: Run) -> Path:
    """The record of a run's fit."""
    return folder / run.model / run.preset / "fit.json"
