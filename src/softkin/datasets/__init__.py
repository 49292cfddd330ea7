"""Datasets: readers by source format, the tidy table all later stages read, and its description."""

from __future__ import annotations

from collections.abc import Callable

from softkin.datasets import published_json
from softkin.interface import Samples

#: Source format (key `format` of a dataset's entry) -> reader(path, dataset=, n_commands=, n_markers=).
READERS: dict[str, Callable[..., dict[str, Samples]]] = {"kinn_json": published_json.read}
