"""Made-up results of two robots: `arm`, whose test rows leak, and `finger`, a stand-in with rows left out."""

from __future__ import annotations

import itertools
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from softkin.core.files import write_json
from softkin.core.runs import PAPER, TUNED
from softkin.core.samples import SUBSETS
from softkin.reporting.page.build import build_report
from softkin.reporting.page.jobs import Job

MODELS = {"lr": "Linear regression", "gb": "Gradient boosting", "gp": "Gaussian process", "mlp": "Perceptron"}
METHODS = {"scp_mapie": "SCP (MAPIE)", "scp_crepes": "SCP (crepes)", "cps": "System", "joint_box": "Box"}
ROBOTS, LEVELS = ("arm", "finger"), (0.8, 0.9)
NOTE = "Training error: copies of train rows."
CARD: dict[str, Any] = {
    "title": "ARM <made up>",
    "worst_severity": "leak",
    "findings": [
        {"severity": "leak", "subsets": ["test"], "sentence": "All rows stand in train.", "consequence": "So what."},
        {"severity": "note", "subsets": ["train"], "sentence": "A remark.", "consequence": "None."},
    ],
    "subsets": {subset: {"rows": 40} for subset in SUBSETS},
}


@dataclass(frozen=True)
class Results:
    """A folder of results, and what `build_report` is called with."""

    folder: Path
    arguments: dict[str, Any]

    def build(self, name: str = "report.html", **changed: Any) -> Path:
        report = self.folder / name
        build_report(**self.arguments | {"report": report} | changed)
        return report


PRESETS = (PAPER, TUNED)


def point_metrics() -> pd.DataFrame:
    rows = []
    for place, (dataset, model, preset, subset) in enumerate(itertools.product(ROBOTS, MODELS, PRESETS, SUBSETS)):
        error = 10.0 ** (place % 9 - 4)
        names = ("rmse_mm", "mae_mm", "r2", "mape_percent", "euclidean_mean_mm", "euclidean_p95_mm")
        row = dict.fromkeys(names, error) | {"fit_seconds": 0.1, "predict_us_per_row": 2.0}
        rows.append({"dataset": dataset, "subset": subset, "model": model, "preset": preset, **row})
    return pd.DataFrame(rows)


def interval_metrics() -> pd.DataFrame:
    rows = []
    runs = itertools.product(ROBOTS, ("test", "extrapolation"), MODELS, PRESETS, METHODS, LEVELS)
    for dataset, subset, model, preset, method, level in runs:
        is_region, promised = method.startswith("joint"), subset == "test"
        key = {"dataset": dataset, "subset": subset, "model": model, "preset": preset}
        key |= {"interval_method": method, "confidence_level": level}
        marginal = "marginal" if promised else "no guarantee"
        # z never moves: it is always covered, and no promise is counted for it.
        coordinates = (("m1_x", level), ("m1_y", 0.1), ("m1_z", 1.0), ("mean_informative", level))
        for coordinate, coverage in coordinates * (not is_region):
            band = (np.nan, np.nan) if coordinate == "mean_informative" else (level - 0.05, level + 0.05)
            holm = 0.5 if coordinate in ("m1_x", "m1_y") else np.nan
            rows.append(
                key
                | {"coordinate": coordinate, "coverage": coverage, "mean_width_mm": 2.0, "winkler_mm": 3.0}
                | {"coverage_p_value_holm": holm}
                | {"guarantee": marginal, "coverage_low": band[0], "coverage_high": band[1], "size_mm": np.nan}
            )
        joint = {"coordinate": "joint", "coverage": 0.7, "mean_width_mm": np.nan, "winkler_mm": np.nan}
        joint |= {"guarantee": "joint" if promised and is_region else "no guarantee", "size_mm": np.inf}
        rows.append(key | joint | {"coverage_low": 0.6, "coverage_high": 0.8})
    return pd.DataFrame(rows)


def frames() -> dict[str, pd.DataFrame]:
    choice = pd.DataFrame(
        [
            {"dataset": dataset, "model": "gp", "preset": "tuned", "interval_method": method, "confidence_level": 0.9}
            | {
                "cv_winkler_mm": 1.0,
                "chosen": method == "cps",
                "deployed": method == "cps",
                "test_coverage": 0.9,
                "test_mean_width_mm": 2e-7,
            }
            | {"test_winkler_mm": 3.0, "winkler_ratio_to_paper": np.nan, "outside": "cps"}
            | {"extrapolation_coverage": 0.8, "extrapolation_mean_width_mm": 0.5}
            for dataset, method in itertools.product(ROBOTS, ("cps", "scp_mapie"))
        ]
    )
    selection = [{"dataset": d, "model": "gp", "preset": "tuned", "deployed": True, "runner_up": "lr"} for d in ROBOTS]
    cells = [
        {"dataset": "arm", "subset": subset, "model": "gb", "metric": metric, "printed": "1.40", "paper_value": 1.4}
        | {"tuned_value": 1.2, "paper_verdict": "reproduced", "tuned_verdict": "better"}
        for subset, metric in itertools.product(("test", "extrapolation"), ("rmse_mm", "r2"))
    ]
    columns = [
        {**{k: c[k] for k in ("dataset", "subset", "metric", "printed")}, "printed_model": "gb", "tuned_value": 1.2}
        | {"tuned_model": "gp", "verdict": "worse"}
        for c in cells
    ]
    intervals = {"dataset": "arm", "interval_method": "scp_mapie", "metric": "coverage", "printed": "0.90"}
    intervals |= {"honest_value": 0.5, "honest_verdict": "lower", "nearest_value": 0.9, "nearest_verdict": "reproduced"}
    key = [{"dataset": d, "model": "gp", "preset": "tuned"} for d in ROBOTS]
    searched = pd.DataFrame(key).assign(target_space="curvature", cv_mae_mm=1.0, shell_mae_mm=2.0, test_mae_mm=1.0)
    searched = searched.assign(extrapolation_mae_mm=2.5, cv_rank_correlation=0.25, shell_rank_correlation=0.75)
    outside = pd.DataFrame([k | {"subset": s} for k in key for s in ("test", "extrapolation")])
    outside = outside.assign(interval_method="cps", confidence_level=0.9, coverage=0.91, mean_width_mm=2.0)
    outside = outside.assign(winkler_mm=3.0, winkler_ratio_to_oracle=1.25, guarantee="no guarantee", labels_used="none")
    spaces = pd.DataFrame([k | {"subset": s} for k in key for s in ("test", "extrapolation")]).drop(columns="preset")
    spaces = pd.concat([spaces.assign(target_space=s, rmse_mm=e) for s, e in (("cartesian", 4.0), ("curvature", 1.0))])
    return {
        "target_spaces": spaces.assign(mae_mm=0.5, is_chosen=spaces["target_space"] == "curvature"),
        "point_metrics": point_metrics(),
        "searched_runs": searched,
        "extrapolation_intervals": outside.assign(refused=["", "too few rows"] * len(ROBOTS)),
        "interval_metrics": interval_metrics(),
        "interval_choice": choice,
        "selection": pd.DataFrame(selection).assign(runner_up_ratio=1.25),
        "published_comparison": pd.DataFrame(cells),
        "published_columns": pd.DataFrame(columns),
        "published_intervals": pd.DataFrame([intervals | {"explanation": "A remark, long enough."}]),
    }


def draw(folder: Path) -> None:
    """Two pictures, one of them not in the index."""
    folder.mkdir(parents=True)
    noise = np.random.default_rng(0).integers(0, 255, (60, 90, 3), dtype=np.uint8)
    for name in ("intervals_paper", "an_extra_one"):
        Image.fromarray(noise).save(folder / f"{name}.png")
    index = {"figure": ["intervals_paper"] * 2, "title": ["Intervals around the paper's model"] * 2}
    index["caption"] = ["How to read it."] * 2
    pd.DataFrame(index).to_csv(folder / "index.csv", index=False)


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("report") / "results"
    tables = []
    for name, frame in frames().items():
        tables.append(folder / "tables" / f"{name}.csv")
        tables[-1].parent.mkdir(parents=True, exist_ok=True)
        frame.to_csv(tables[-1], index=False)
    sources: dict[str, Any] = {}
    for dataset in ROBOTS:
        sources[dataset] = {"title": dataset.upper(), "file": f"{dataset}.json", "citation": "Someone (2023). Data."}
        about = {"dataset": dataset, "title": f"{dataset.upper()} <made up>", "sha256": "ab" * 32, "n_commands": 2}
        about |= {"n_markers": 1, "rows": dict.fromkeys(SUBSETS, 40), "constant_coordinates": []}
        about |= {"is_cut": True, "origin": "stand-in"} if dataset == "finger" else {"is_cut": False}
        write_json(folder / dataset / "dataset.json", about)
        draw(folder / dataset / "figures")
    draw(folder / "tables" / "figures")
    sources["arm"]["notes"] = {"test": NOTE}
    card = folder / "arm" / "data_card.json"
    write_json(card, CARD)
    table = "| subset | rows <b> |\n| --- | --- |\n| test | 40 |\n"
    card.with_suffix(".md").write_text(f"# Card of ARM <made up>\n\n## The rows\n\n{table}")
    benchmark, record = folder / "benchmarks" / "gp.tsv", folder / "parameters.json"
    benchmark.parent.mkdir()
    benchmark.write_text("s\tmax_rss\tcpu_time\n75.5\t200\t60\n")
    write_json(record, {"n_trials": 30, "n_pruned": 4})
    house = folder.parent / "house"
    house.mkdir()
    citation = house / "CITATION.cff"
    citation.write_text("title: softkin\nversion: 1.0\nauthors: [{name: The authors}]\n")
    for command in (["init", "-q"], ["add", "."], ["-c", "user.name=me", "-c", "user.email=@", "commit", "-qm", "one"]):
        subprocess.run(["git", "-C", str(house), *command], check=True)
    config = {
        "campaign": "made-up",
        "seed": 7,
        "datasets": [*ROBOTS],
        "tracking_uri": "postgresql://me:secret@host/db",
        "sources": sources,
    }
    arguments = {
        "tables": tables,
        "descriptions": {dataset: folder / dataset / "dataset.json" for dataset in ROBOTS},
        "data_cards": {"arm": card},
        "card_pages": {"arm": card.with_suffix(".md")},
        "figures": {dataset: folder / dataset / "figures" for dataset in ROBOTS},
        "campaign_figures": folder / "tables" / "figures",
        "jobs": [
            Job("tune", "arm", "gp", "tuned", benchmark, (record,)),
            Job("intervals", "arm", "", "", benchmark),
        ],
        "config": config | {"data_mirror": "/private/place"},
        "model_titles": MODELS,
        "interval_titles": METHODS,
        "citation": citation,
    }
    return Results(folder, arguments)


@pytest.fixture(scope="session")
def page(results: Results) -> Path:
    """The whole page of these results."""
    return results.build()
