"""Measure what a bound on the rows of a fit costs and saves, on simulated robots of 26,000 rows of `train`.

    python -m benchmarks.fit_rows [--rows 5000 10000 26000] [--models gb xgb ...] [--quantiles gb xgb]

Two robots: the arm of `benchmark-two-files`, recorded at 120 Hz, whose models are told of earlier commands; and an arm
of three commands that are drawn by themselves, so that no row stands beside another. Each model is fitted with its
first trial, quantile regressors with the paper's settings, too, on ever more rows of `train`, and scored on rows that
it has not seen: of the recording its last fifth. Prints the mean absolute error (mm; of quantile regressors the pinball
loss) and CPU seconds of the fit and of predicting 4,000 rows once.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
import pandas as pd
from optuna.trial import FixedTrial

from benchmarks.commands import arm
from benchmarks.two_files import recording
from softkin.core.metrics.pinball import pinball_losses
from softkin.core.recording import CommandMemory
from softkin.core.rows import sampled_rows
from softkin.core.runs import PAPERS_LEVEL
from softkin.core.samples import Array, Params, Samples
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.fit_quantiles import QuantileModel
from softkin.training.kinematic_model import FitSettings, fitted_model

N_TRAIN, N_TEST, SEED = 26_000, 4_000, 2026
PLAY = {"memory": "play", "widths": "fine", "zeros": True}


def robots() -> dict[str, tuple[Samples, Samples]]:
    """Rows of `train` and `test` by the robot's name, of one marker each."""
    commands, positions = recording(N_TRAIN * 5 // 4)
    memory = CommandMemory.of(commands).recorded(commands, np.arange(len(commands)), np.ones(len(commands), dtype=int))
    recorded = Samples(commands, positions[:, -3:], memory)
    test = N_TRAIN + sampled_rows(len(commands) - N_TRAIN, N_TEST, SEED)
    table = arm(N_TRAIN + N_TEST, 3).to_numpy()
    drawn = Samples(table[:, :3], table[:, -3:])
    return {
        "recorded arm": (recorded.take(slice(N_TRAIN)), recorded.take(test)),
        "arm of drawn commands": (drawn.take(slice(N_TRAIN)), drawn.take(slice(N_TRAIN, None))),
    }


def point(model: str, params: Params, train: Samples, test: Samples) -> float:
    """Mean absolute error (mm) on `test`."""
    memory = None if train.recording is None else PLAY
    settings = FitSettings(params, True, SEED, 1, memory=memory)
    fitted = fitted_model(MODELS[model], settings, train)
    return float(np.abs(fitted.predict(test.inputs) - test.positions).mean())


def quantile(model: str, params: Params, train: Samples, test: Samples) -> float:
    """Mean pinball loss (mm) of the pair of quantiles of the paper's level."""
    fitted = QuantileModel(QUANTILE_MODELS[model], params, [PAPERS_LEVEL], SEED, 1).fit(train)
    pair: Array = fitted.predict(test.commands)[0]
    sides = enumerate(((1 - PAPERS_LEVEL) / 2, (1 + PAPERS_LEVEL) / 2))
    return float(np.mean([pinball_losses(test.positions, pair[..., side], of).mean() for side, of in sides]))


def fits(models: list[str], quantiles: list[str]) -> list[tuple[str, Callable[..., float], str, Params]]:
    """What is fitted: its name, the function that scores it, the entry's name, the parameters."""
    found: list[tuple[str, Callable[..., float], str, Params]] = []
    for name in models:
        spec = MODELS[name]
        found.append((name, point, name, spec.search_space(FixedTrial(dict(spec.first_trials[0])))))
    for name in quantiles:
        of = QUANTILE_MODELS[name]
        found.append((f"quantiles {name}", quantile, name, of.search_space(FixedTrial(dict(of.first_trials[0])))))
        found.append((f"quantiles {name}, paper", quantile, name, of.paper_params))
    return found


def main() -> None:
    """Fit, score, print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, nargs="*", default=[2_500, 5_000, 10_000, N_TRAIN])
    parser.add_argument("--models", nargs="*", default=[*MODELS])
    parser.add_argument("--quantiles", nargs="*", default=[*QUANTILE_MODELS])
    options = parser.parse_args()
    rows = []
    for robot, (train, test) in robots().items():
        for name, score, entry, params in fits(options.models, options.quantiles):
            for n_rows in options.rows:
                start = time.process_time()
                error = score(entry, params, train.take(sampled_rows(len(train), n_rows, SEED)), test)
                cpu = time.process_time() - start
                rows.append({"robot": robot, "fit": name, "rows": n_rows, "error_mm": error, "cpu_s": cpu})
                print(f"{robot}, {name}, {n_rows} rows: {error:.4f} mm, {cpu:.1f} s of CPU", flush=True)
    table = pd.DataFrame(rows).pivot(index=["robot", "fit"], columns="rows", values=["error_mm", "cpu_s"])
    print(table.round(4).to_string())


if __name__ == "__main__":
    main()
