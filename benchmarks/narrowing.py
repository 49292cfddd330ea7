"""What a dataset loses on `train` when fewer models and presets are fitted to it, and the CPU seconds that this saves.

    python -m benchmarks.narrowing --results results --dataset finger_recorded --most-cpu 100

Of a finished run in which all models were fitted it reads, of one dataset, the studies and what each run predicts of
held-out rows of `train`; nothing is fitted, and no other subset is read. For each choice of models and presets it
prints the CPU seconds of the studies and the run that would be deployed for both objectives, with its scores.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.ensembles import configuration_of, held_out_of
from softkin.core.files import read_json
from softkin.core.runs import BOTH, SEARCHED, Run
from softkin.models.ensembles import ENSEMBLES
from softkin.training.ensemble import Pool
from softkin.training.held_out import SCORES
from softkin.training.selection import OBJECTIVES

#: Models of a choice at most, beside all of them.
MOST_MODELS = 3


class Studies:
    """The studies of a `dataset` in a folder of `results`, and what its runs predict of held-out rows of `train`."""

    def __init__(self, results: Path, dataset: str) -> None:
        config = configuration_of(results)
        self.models: list[str] = config["models"]
        self.truth, self.held_out = held_out_of(results, dataset)
        folder = results / dataset
        self.found = {run: read_json(folder / run.model / run.preset / "parameters.json") for run in self.held_out}
        self.ensembles = {name: ENSEMBLES[name] for name in config["ensembles"]}

    def chosen(self, models: Sequence[str], presets: Sequence[str]) -> dict[str, Any]:
        """What would be deployed of these models and presets, its scores (mm), and what their studies took."""
        runs = [run for run in self.found if run.model in models and run.preset in presets]
        scores = [{"run": " ".join(run)} | {name: self.found[run][name] for name in SCORES.values()} for run in runs]
        pool = Pool(self.truth, {run: self.held_out[run] for run in runs})
        for name, spec in self.ensembles.items():
            for preset in presets:
                best = pool.steps(spec, preset, range(len(self.truth[preset]))).best
                own = {preset: pool.left_out_score(spec, preset)}
                errors = {SCORES[by]: own[by] if by in own else pool.score(best, by) for by in self.truth}
                scores.append({"run": f"{name} {preset}"} | errors)
        frame = pd.DataFrame(scores)
        frame["both_mm"] = OBJECTIVES[BOTH](frame)
        cpu = sum(self.found[run]["cpu_seconds"] for run in runs)
        key = {"models": " ".join(models), "presets": " ".join(presets), "studies_cpu_s": cpu}
        return key | dict(frame.loc[int(np.argmin(frame["both_mm"]))])

    def choices(self, most_cpu: float) -> Iterator[dict[str, Any]]:
        """Each choice of some models and presets whose studies take at most so many CPU seconds, and all of them."""
        yield self.chosen(self.models, SEARCHED)
        for presets in [tuple(part) for size in (1, 2) for part in combinations(SEARCHED, size)]:
            for models in [part for size in range(1, MOST_MODELS + 1) for part in combinations(self.models, size)]:
                if sum(self.found[Run(model, of)]["cpu_seconds"] for model in models for of in presets) <= most_cpu:
                    yield self.chosen(models, presets)


def main() -> None:
    """Read, choose, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--dataset", required=True)
    parser.add_argument("--most-cpu", type=float, default=100.0, help="CPU seconds of all studies of a choice at most")
    parser.add_argument("--shown", type=int, default=20, help="how many of the best are printed")
    options = parser.parse_args()
    frame = pd.DataFrame(Studies(options.results, options.dataset).choices(options.most_cpu))
    print(f"{len(frame) - 1} choices; all models and presets first, then the best by the mean of both scores")
    ordered = pd.concat([frame.head(1), frame.iloc[1:].sort_values("both_mm", kind="stable").head(options.shown)])
    print(ordered.round(4).to_string(index=False))


if __name__ == "__main__":
    main()
