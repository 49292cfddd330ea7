"""Archives (npz) of arrays that belong to runs: the predictions of refitted models."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.files import replacing
from softkin.core.runs import Run

#: Names (n_arrays, 3) of the arrays of runs in the file: model, preset and part; array i is `of_run_{i}`.
INDEX = "of_runs"
#: CPU seconds of all fits together: a shared array without dimensions.
CPU_SECONDS = "fit_cpu_seconds"


@dataclass(frozen=True)
class RunArchive:
    """`shared` arrays by name, and arrays `of_runs` by run and the part of `train` they belong to."""

    shared: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    of_runs: Mapping[tuple[Run, str], NDArray[Any]] = field(default_factory=dict)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the archive in one step, compressed."""
        index = np.array([[*run, part] for run, part in self.of_runs], dtype=np.str_).reshape(-1, 3)
        arrays = {f"of_run_{place}": array for place, array in enumerate(self.of_runs.values())}
        with replacing(path) as temporary, temporary.open("wb") as file:
            np.savez_compressed(file, **{**self.shared, INDEX: index, **arrays})  # type: ignore[arg-type]


def read_run_archive(path: str | os.PathLike[str] | None) -> RunArchive:
    """The archive in a file; an empty one where there is no file."""
    if path is None:
        return RunArchive()
    with np.load(path) as stored:
        arrays = dict(stored)
    names = [(Run(str(model), str(preset)), str(part)) for model, preset, part in arrays.pop(INDEX)]
    of_runs = {name: arrays.pop(f"of_run_{place}") for place, name in enumerate(names)}
    return RunArchive(arrays, of_runs)
