"""A folder of made-up results: `finger`, which the paper has, and `arm`, whose test rows leak and are cut."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from softkin.core.files import write_json
from softkin.core.samples import SUBSETS
from softkin.reporting.tables.frames import DatasetFiles, PublishedFiles, Tables, read_tables
from tests.conftest import HOUSE

SOURCES: dict[str, dict[str, Any]] = {
    "finger": {"title": "FINGER", "paper_table": 5, "notes": {"extrapolation": "Far out."}},
    "arm": {"title": "ARM"},
}
RUNS = (("gb", "paper", 2.0), ("gb", "tuned", 1.0), ("lr", "paper", 4.0), ("lr", "tuned", 3.0))
LEAK = {"severity": "leak", "subsets": ["test"], "sentence": "All rows stand in train.", "consequence": "No test."}
PUBLISHED = HOUSE / "resources" / "published"
CSV = ("point", "markers", "intervals", "choice", "conditional", "alarms", "extrapolation", "spaces", "left_out")


@dataclass(frozen=True)
class Run:
    """Result files of the datasets, and the files of best parameters."""

    datasets: Mapping[str, DatasetFiles]
    parameters: Mapping[tuple[str, str, str], Path]

    def tables(self, searched: bool = True) -> Tables:
        published = PublishedFiles(
            *(
                PUBLISHED / f"{name}.csv"
                for name in ("point_metrics", "subsets", "interval_metrics", "approaches", "improvements")
            )
        )
        return read_tables(
            self.datasets,
            sources={name: SOURCES[name] for name in self.datasets},
            parameters=self.parameters if searched else {},
            objective="both",
            published=published,
        )


def _point(dataset: str) -> list[dict[str, Any]]:
    metrics = ("rmse_mm", "mae_mm", "r2", "mape_percent", "mae_informative_mm", "euclidean_mean_mm", "euclidean_p95_mm")
    return [
        {"dataset": dataset, "subset": subset, "model": model, "preset": preset} | dict.fromkeys(metrics, error)
        for model, preset, error in RUNS
        for subset in SUBSETS
    ]


def _intervals(dataset: str) -> list[dict[str, Any]]:
    return [
        {"dataset": dataset, "subset": subset, "model": model, "preset": preset, "interval_method": method}
        | {"coordinate": coordinate, "confidence_level": 0.9, "guarantee": "marginal"}
        | {"coverage_low": 0.8, "coverage_high": 0.95, "coverage_p_value_holm": 0.5}
        | {"coverage": 0.91, "mean_width_mm": 2.0 * error, "winkler_mm": 3.0 * error}
        | {"winkler_without_gross_mm": 2.5 * error, "n_commands": 12 if dataset == "arm" else 40}
        for model, preset, error in RUNS
        for method in ("cqr", "scp_mapie")
        for subset in ("test", "extrapolation")
        for coordinate in ("m1_x", "mean_informative")
    ]


def _left_out(dataset: str) -> list[dict[str, Any]]:
    """One row sets the error of a run on test."""
    row = {"dataset": dataset, "subset": "test", "left_out": "row 3", "model": "gb", "preset": "tuned"}
    return [row | {"interval_method": "", "metric": "rmse_mm", "value": 1.0, "without": 0.1}]


def _choice() -> list[dict[str, Any]]:
    return [
        {"model": "gb", "preset": "tuned", "interval_method": method, "confidence_level": 0.9, "cv_winkler_mm": score}
        | {"chosen": method == "cqr", "deployed": method != "cqr", "outside": method}
        for method, score in (("cqr", 1.0), ("scp_mapie", 2.0))
    ]


def write_dataset(folder: Path, dataset: str) -> DatasetFiles:
    folder.mkdir()
    plain = [{"dataset": dataset, "subset": subset, "value": 1.0} for subset in SUBSETS]
    rows = dict.fromkeys(CSV, plain) | {
        "point": _point(dataset),
        "intervals": _intervals(dataset),
        "choice": _choice(),
        "alarms": [{"dataset": dataset, "alpha": 0.1}],
        "left_out": _left_out(dataset),
    }
    for name, table in rows.items():
        pd.DataFrame(table).to_csv(folder / f"{name}.csv", index=False)
    is_arm = dataset == "arm"
    description = {
        "dataset": dataset,
        "origin": "own" if is_arm else "published",
        "title": SOURCES[dataset]["title"],
        "is_cut": is_arm,
        "n_commands": 2,
    }
    write_json(folder / "dataset.json", description | {"n_markers": 1, "rows": dict.fromkeys(SUBSETS, 40)})
    card = {"dataset": dataset, "is_leaking": is_arm, "findings": [LEAK] if is_arm else [], "checks": {}}
    write_json(folder / "data_card.json", card)
    names = (*(f"{name}.csv" for name in CSV), "dataset.json", "data_card.json")
    return DatasetFiles(*(folder / name for name in names))


def write_run(folder: Path) -> Run:
    datasets = {dataset: write_dataset(folder / dataset, dataset) for dataset in SOURCES}
    parameters = {}
    for dataset in SOURCES:
        for model, score in (("gb", 1.0), ("lr", 2.0)):
            path = folder / dataset / f"{model}.json"
            write_json(path, {"cv_mae_mm": score, "shell_mae_mm": score, "target_space": "cartesian"})
            parameters[dataset, model, "tuned"] = path
    return Run(datasets, parameters)


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Files that a test may change."""
    return write_run(tmp_path)
