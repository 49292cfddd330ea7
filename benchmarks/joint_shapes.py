"""What a region that holds whole poses costs by its shape, and which one `train` chooses; test is not read.

    python -m benchmarks.joint_shapes [--results results]

Of each dataset of a finished run, around the deployed model, at 90 %: the size of the box, of ellipsoids, and of
ellipsoids whose shape does not cap gross errors; shaped on `train`, calibrated on four folds of `validation`, ten times
five of them. The size is the side of a cube of the same volume, in mm. Then the share of held-out poses that the chosen
region holds, and that the intervals of single coordinates of the paper's recipe do.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sklearn.model_selection import KFold

from softkin.core.runs import Run
from softkin.core.samples import TRAIN, VALIDATION, Array, informative_coordinates
from softkin.data.table import read_subset
from softkin.training.predict import predicted_rows
from softkin.uncertainty.conformal import conformal_limits
from softkin.uncertainty.joint_region import chosen_shape
from softkin.uncertainty.regions import box, ellipsoids
from softkin.uncertainty.regions.spec import Shape, of_shape

LEVEL, N_FOLDS, N_DRAWS = 0.9, 5, 10


def main() -> None:
    """Print a line for each dataset."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=Path("results"))
    folders = sorted(path.parent for path in parser.parse_args().results.glob("*/table.parquet"))
    print(f"{'dataset':<18} {'chosen':<11} {'box':>9} {'ellipsoids':>11} {'uncapped':>9} {'holds':>7} {'single':>7}")
    for folder in folders:
        train, validation, moving = residuals(folder)
        markers = np.flatnonzero(moving) // 3
        shapes: list[Shape] = [
            box.shape(train, markers),
            ellipsoids.shape(train, markers),
            ellipsoids.shape(train, markers, np.inf),
        ]
        sizes = [size(shape, validation) for shape in shapes]
        chosen = chosen_shape(train, markers)
        shares = np.mean([held(chosen, *part) for part in parts(validation)], axis=0)
        numbers = f"{sizes[0]:>9.3g} {sizes[1]:>11.3g} {sizes[2]:>9.3g} {shares[0]:>7.1%} {shares[1]:>7.1%}"
        print(f"{folder.name:<18} {chosen.kind:<11} {numbers}")


def residuals(folder: Path) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Of the moving coordinates on `train` and on `validation` in mm, around the deployed model; which move."""
    choice = pd.read_csv(folder / "interval_choice.csv").query("deployed").iloc[0]
    run = Run(choice["model"], choice["preset"])
    stored = pd.read_parquet(folder / run.model / run.preset / "predictions.parquet")
    truth = {subset: read_subset(folder / "table.parquet", subset).positions for subset in (TRAIN, VALIDATION)}
    moving = informative_coordinates(truth[TRAIN])
    train, validation = ((true - predicted_rows(stored, [subset]))[:, moving] for subset, true in truth.items())
    return train, validation, moving


def parts(rows: Array) -> list[tuple[Array, Array]]:
    """Calibration rows and held-out rows, over all folds and draws."""
    folds = (KFold(N_FOLDS, shuffle=True, random_state=seed).split(rows) for seed in range(N_DRAWS))
    return [(rows[most], rows[rest]) for draw in folds for most, rest in draw]


def size(shape: Shape, validation: Array) -> float:
    """Geometric mean of the size in mm over all parts of the calibration set."""
    sizes = [of_shape(shape, calibration, LEVEL).size_mm for calibration, _ in parts(validation)]
    return float(np.exp(np.mean(np.log(sizes))))


def held(shape: Shape, calibration: Array, new: Array) -> tuple[float, float]:
    """Share of new poses that the region holds, and that all of the paper's intervals do."""
    single = conformal_limits(np.abs(calibration), [LEVEL])[0]
    region = of_shape(shape, calibration, LEVEL)
    return float(region.covers(new).mean()), float((np.abs(new) <= single).all(axis=1).mean())


if __name__ == "__main__":
    main()
