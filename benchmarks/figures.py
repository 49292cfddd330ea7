"""Measure the time and memory of the figures of a large robot: under 500 MB?

    python -m benchmarks.figures [--rows 100000] [--commands 3] [--markers 2] [--limit 500] [--keep FOLDER]

Writes made-up results of every model, preset and interval method at three levels, as a finished run leaves them, then
draws all figures of the dataset from them in a process of its own, as the rule draw_figures does. Prints the rows, the
largest memory that drawing held (MB) and its CPU seconds. The exit status is 1 beyond `--limit` MB.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from resource import struct_rusage

    from softkin.core.samples import Samples

LEVELS = (0.8, 0.9, 0.95)
SUBSETS_WITH_INTERVALS = ("test", "extrapolation")
N_TRIALS = 60


def write_results(folder: Path, n_rows: int, n_commands: int, n_markers: int) -> None:
    """Made-up results: errors of 1 mm, intervals that widen with the level, studies of `N_TRIALS` trials."""
    from benchmarks.audit import made_up
    from softkin.data.table import to_table, write_table

    subsets = made_up(n_rows, n_commands, n_markers)
    write_table(to_table(subsets), folder / "table.parquet")
    _write_predictions(folder, subsets)
    _write_intervals(folder, subsets)
    _write_scores(folder, n_markers)
    _write_studies(folder)


def _runs() -> list[tuple[str, str]]:
    from softkin.core.runs import PRESETS
    from softkin.models import MODELS

    return [(model, preset) for model in MODELS for preset in PRESETS]


def _write_predictions(folder: Path, subsets: dict[str, Samples]) -> None:
    import numpy as np
    import pandas as pd

    from softkin.core.samples import coordinate_columns

    rng = np.random.default_rng(1)
    names = coordinate_columns(next(iter(subsets.values())).positions.shape[1] // 3)
    for model, preset in _runs():
        frames = []
        for subset, samples in subsets.items():
            guess = samples.positions + rng.standard_normal(samples.positions.shape)
            frames.append(pd.DataFrame(guess, columns=names).assign(subset=subset))
        pd.concat(frames).to_parquet(folder / f"predictions_{model}_{preset}.parquet")


def _write_intervals(folder: Path, subsets: dict[str, Samples]) -> None:
    """One file of the same intervals under the name of each method: only the size of the files counts."""
    import numpy as np
    import pandas as pd

    from softkin.core.bounds import ROW_GROUP, bounds_frame
    from softkin.uncertainty.intervals import INTERVAL_METHODS

    rng = np.random.default_rng(2)
    frames = []
    for model, preset in _runs():
        for subset in SUBSETS_WITH_INTERVALS:
            centre = subsets[subset].positions + rng.standard_normal(subsets[subset].positions.shape)
            for level in LEVELS:
                half = 2 * level * rng.uniform(0.5, 1.5, centre.shape)
                frame = bounds_frame(np.stack([centre - half, centre + half], axis=-1), subset, level)
                frame.insert(0, "model", model)
                frame.insert(1, "preset", preset)
                frames.append(frame)
    first, *others = (folder / f"{method}.parquet" for method in INTERVAL_METHODS)
    pd.concat(frames, ignore_index=True).to_parquet(first, row_group_size=ROW_GROUP)
    for other in others:
        other.hardlink_to(first)


def _write_scores(folder: Path, n_markers: int) -> None:
    """The tables of scores that figures read; their size does not depend on the rows."""
    import pandas as pd

    from softkin.core.samples import coordinate_columns
    from softkin.models import MODELS
    from softkin.uncertainty.intervals import INTERVAL_METHODS

    tables: dict[str, list[dict[str, Any]]] = {name: [] for name in ("point", "metrics", "groups", "beyond", "spaces")}
    band = {"coverage_low": 0.88, "coverage_high": 0.92, "coverage_p_value": 0.5, "guarantee": "marginal"}
    for model, preset in _runs():
        run = {"model": model, "preset": preset}
        for subset in SUBSETS_WITH_INTERVALS:
            tables["point"].append(run | {"subset": subset, "euclidean_mean_mm": 1.0 + len(tables["point"])})
            for method in INTERVAL_METHODS:
                key = run | {"subset": subset, "interval_method": method, "coverage": 0.9}
                for level in LEVELS:
                    for name in (*coordinate_columns(n_markers), "mean_informative"):
                        tables["metrics"].append(key | band | {"coordinate": name, "confidence_level": level})
        for method in INTERVAL_METHODS:
            for group in "12345":
                key = run | {"interval_method": method, "by": "width", "group": group, "confidence_level": 0.9}
                tables["groups"].append(key | {"coverage": 0.9, "standard_error": 0.01})
    for subset in SUBSETS_WITH_INTERVALS:
        for method in INTERVAL_METHODS:
            key = {"model": "gb", "preset": "paper", "interval_method": method, "subset": subset, "refused": ""}
            key |= {"confidence_level": 0.9, "coverage": 0.9, "winkler_ratio_to_oracle": 2.0, "infinite_share": 0.0}
            tables["beyond"].append(key | {"guarantee": "marginal", "labels_used": "none"})
        for model in MODELS:
            for space in ("cartesian", "curvature"):
                key = {"subset": subset, "model": model, "target_space": space, "rmse_mm": 1.0, "mae_mm": 2.0}
                tables["spaces"].append(key | {"is_chosen": space == "curvature"})
    for name, rows in tables.items():
        pd.DataFrame(rows).to_csv(folder / f"{name}.csv", index=False)
    methods = ("scp_spread", "scp_mapie", "scp_distance", "cps", "cqr")
    choice = [{"model": "gp", "preset": "tuned", "interval_method": method} for method in methods]
    pd.DataFrame(choice).assign(confidence_level=0.9).to_csv(folder / "choice.csv", index=False)


def _write_studies(folder: Path) -> None:
    import numpy as np
    import pandas as pd

    from softkin.models import MODELS

    rng = np.random.default_rng(3)
    for model in MODELS:
        rate, depth = rng.uniform(0.1, 1.0, N_TRIALS), rng.integers(2, 9, N_TRIALS)
        scores = {"score_mm": 1.0 + 5.0 * rate, "first_part_mm": 1.0 + 4.0 * rate}
        trials = {"trial": np.arange(N_TRIALS), **scores, "param_rate": rate, "param_depth": depth}
        pd.DataFrame(trials).to_csv(folder / f"trials_{model}.csv", index=False)


def draw_all(folder: Path) -> None:
    """Draw every figure of the made-up dataset: what the script of the rule does."""
    from softkin.core.runs import Run
    from softkin.models import MODELS
    from softkin.reporting.figures import FIGURES
    from softkin.reporting.figures.drawing import draw
    from softkin.reporting.figures.spec import DatasetResults
    from softkin.uncertainty.intervals import INTERVAL_METHODS

    results = DatasetResults(
        dataset="large",
        title="Large",
        table=folder / "table.parquet",
        predictions={Run(*run): folder / f"predictions_{'_'.join(run)}.parquet" for run in _runs()},
        trials={model: folder / f"trials_{model}.csv" for model in MODELS},
        intervals={method: folder / f"{method}.parquet" for method in INTERVAL_METHODS},
        point=folder / "point.csv",
        interval_metrics=folder / "metrics.csv",
        choice=folder / "choice.csv",
        conditional=folder / "groups.csv",
        extrapolation=folder / "beyond.csv",
        target_spaces=folder / "spaces.csv",
        notes={},
        model_titles={name: spec.title for name, spec in MODELS.items()},
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        has_own_regressors={name: not of.calibrated_on.is_around_a_model for name, of in INTERVAL_METHODS.items()},
    )
    draw(FIGURES, results, folder / "figures")
    missing = [name for name in FIGURES if not (folder / "figures" / f"{name}.png").is_file()]
    if missing:
        raise SystemExit(f"not drawn: {', '.join(missing)}")


def in_a_process(*arguments: str) -> struct_rusage:
    """What this module used when it was run with these arguments, in a process that inherits no memory."""
    process = subprocess.Popen([sys.executable, "-m", "benchmarks.figures", *arguments])
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(process.returncode)
    return used


def main() -> int:
    """Write, draw, print; the exit status is 1 beyond the limit."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, default=100_000)
    parser.add_argument("--commands", type=int, default=3)
    parser.add_argument("--markers", type=int, default=2)
    parser.add_argument("--limit", type=float, default=500.0, help="MB of memory")
    parser.add_argument("--keep", type=Path, help="work in this new folder and leave it")
    parser.add_argument("--only", choices=["write", "draw"], help="in the folder that --keep names")
    options = parser.parse_args()
    sizes = [f"--{name}={getattr(options, name)}" for name in ("rows", "commands", "markers")]
    if options.only == "write":
        write_results(options.keep, options.rows, options.commands, options.markers)
        return 0
    if options.only == "draw":
        draw_all(options.keep)
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        in_a_process("--only=write", f"--keep={folder}", *sizes)
        used = in_a_process("--only=draw", f"--keep={folder}")
    megabytes = used.ru_maxrss / 1024
    print(f"{options.rows} rows: {megabytes:.0f} MB at most, {used.ru_utime + used.ru_stime:.1f} s of CPU")
    return int(megabytes > options.limit)


if __name__ == "__main__":
    sys.exit(main())
