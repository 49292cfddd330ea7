"""Measure what commands cost: CPU seconds of a fit of each model on robots of 16, 64 and 256 commands.

    python -m benchmarks.command_cost [--commands 16 64 256] [--rows 800] [--models lr rf gb]

Each model of the pool with the paper's settings on a bending arm of two markers, one fit, one thread, on as many rows
as a trial of a study sees. Prints a table for docs/scaling.md.
"""

from __future__ import annotations

import argparse
import time

from benchmarks.commands import arm
from softkin.core.samples import Samples
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model


def cpu_seconds(model: str, samples: Samples) -> float:
    """Of one fit of `model` with the paper's settings."""
    settings = FitSettings(params=dict(MODELS[model].paper_params), skip_constant=False, seed=0, threads=1)
    start = time.process_time()
    fitted_model(MODELS[model], settings, samples)
    return time.process_time() - start


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--commands", type=int, nargs="+", default=[16, 64, 256])
    parser.add_argument("--rows", type=int, default=800)
    parser.add_argument("--models", nargs="+", choices=[*MODELS], default=[*MODELS])
    options = parser.parse_args()
    robots = {}
    for n_commands in options.commands:
        values = arm(options.rows, n_commands).to_numpy()
        robots[n_commands] = Samples(values[:, :n_commands], values[:, n_commands:])
    print(f"| model | {' | '.join(f'{n} commands' for n in robots)} |\n|{' --- |' * (1 + len(robots))}")
    for model in options.models:
        spent = [cpu_seconds(model, samples) for samples in robots.values()]
        print(f"| `{model}` | {' | '.join(f'{seconds:.2f} s' for seconds in spent)} |", flush=True)


if __name__ == "__main__":
    main()
