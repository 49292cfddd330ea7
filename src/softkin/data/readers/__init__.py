"""Readers of datasets, by the format of their files. One file a reader, one line here."""

from __future__ import annotations

from collections.abc import Callable

from softkin.core.samples import Samples
from softkin.data.readers import published_json, simulated, table_file

#: Source format (key `format` of a dataset's entry) -> reader(path, dataset=, source=), `source` the whole entry.
READERS: dict[str, Callable[..., dict[str, Samples]]] = {
    "kinn_json": published_json.read,
    "table_file": table_file.read,
    "simulated": simulated.read,
}

#: Source formats whose columns have names: their readers tell them (own_columns=).
WITH_NAMES = ("table_file",)
