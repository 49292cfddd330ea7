"""Tables that a program nested in dictionaries and lists, as JSON and Parquet hold them: records, columns, or parts of
these under other keys.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from softkin.core.errors import DataError

Columns = dict[str, list[Any]]
_FIX = 'write a list of records, such as [{"u1": 1, "x": 2}, ...]'


def columns_of(content: Any) -> Columns:
    """Columns of a table, each name with its values (n_rows,): of a list of records; of columns; of what pandas writes
    (`split`, `table`, `index`, `columns`); of rows as lists, the first of them names; or of the only such table under
    one of the keys. A value that is a dictionary becomes a column for each of its keys: `tip.x`.

    Raises:
        DataError: there is no such table, or several.
    """
    found = _table(content)
    if found is None and isinstance(content, Mapping):
        tables = {key: table for key, value in content.items() if (table := _table(value)) is not None}
        if len(tables) > 1:
            raise DataError(
                f"several tables, under the keys {', '.join(tables)}", fix="write each to a file of its own"
            )
        found = next(iter(tables.values()), None)
    if found is None:
        raise DataError("neither records nor columns", fix=_FIX)
    return found


def flat(record: Mapping[str, Any]) -> dict[str, Any]:
    """A record whose dictionaries are spread: `{"tip": {"x": 1}}` becomes `{"tip.x": 1}`.

    >>> flat({"u": 1, "tip": {"x": 2}})
    {'u': 1, 'tip.x': 2}
    """
    spread: dict[str, Any] = {}
    for key, value in record.items():
        if isinstance(value, Mapping):
            spread |= {f"{key}.{name}": inner for name, inner in flat(value).items()}
        else:
            spread[key] = value
    return spread


def _table(content: Any) -> Columns | None:
    """The table that the content itself is; None where it is none."""
    if isinstance(content, list):
        return _of_list(content)
    if not isinstance(content, Mapping) or not content:
        return None
    if isinstance(content.get("columns"), list) and isinstance(content.get("data"), list):
        return _of_rows([str(name) for name in content["columns"]], content["data"])
    if isinstance(content.get("schema"), Mapping) and isinstance(content.get("data"), list):
        return _of_list(content["data"])
    spread = flat(content)
    if all(isinstance(value, list) for value in spread.values()):
        return None if _are_tables(spread) else spread
    if all(isinstance(value, Mapping) for value in content.values()):
        return _of_labels(content)
    return None


def _of_list(content: Sequence[Any]) -> Columns | None:
    if content and all(isinstance(record, Mapping) for record in content):
        records = [flat(record) for record in content]
        names = list(dict.fromkeys(name for record in records for name in record))
        return {name: [record.get(name) for record in records] for name in names}
    if len(content) > 1 and all(isinstance(row, list) for row in content):
        if not all(isinstance(name, str) for name in content[0]):
            raise DataError("rows of numbers without names", fix=f"put a list of the columns' names first, or {_FIX}")
        return _of_rows(content[0], content[1:])
    return None


def _of_rows(names: Sequence[str], rows: Sequence[Any]) -> Columns:
    wrong = next((place for place, row in enumerate(rows) if len(row) != len(names)), None)
    if wrong is not None:
        raise DataError(
            f"{len(rows[wrong])} values for {len(names)} columns",
            where=f"row {wrong} (the first is 0)",
            fix="write one value for each column",
        )
    return {name: [row[place] for row in rows] for place, name in enumerate(names)}


def _of_labels(content: Mapping[str, Any]) -> Columns | None:
    """Columns by name, their values by the label of the row, or the other way round."""
    inner = [[*value] for value in content.values()]
    if any(names != inner[0] for names in inner) or not inner[0]:
        return None
    rows_outside = all(str(label).isdecimal() for label in content)
    if rows_outside:
        return _of_list(list(content.values()))
    if not all(str(label).lstrip("-").isdecimal() for label in inner[0]):
        return None
    return {name: list(values.values()) for name, values in content.items()}


def _are_tables(columns: Mapping[str, Sequence[Any]]) -> bool:
    """Whether lists that stand side by side are tables of records each, and no columns."""
    return all(len(values) and all(isinstance(value, Mapping) for value in values) for values in columns.values())
