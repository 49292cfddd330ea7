"""Datasets: readers by source format, the tidy table all later stages read, and its description."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from softkin.datasets import published_json, simulated, table_file
from softkin.interface import Samples

#: Source format (key `format` of a dataset's entry) -> reader(path, dataset=, source=), `source` the whole entry.
READERS: dict[str, Callable[..., dict[str, Samples]]] = {
    "kinn_json": published_json.read,
    "table_file": table_file.read,
    "simulated": simulated.read,
}


def reader_files(source_format: str) -> list[Path]:
    """The files that decide what the reader of a format gives."""
    module = sys.modules[READERS[source_format].__module__]
    return [Path(str(module.__file__)), *getattr(module, "ALSO_DECIDED_BY", ())]
