"""Say what differs between two campaigns besides their numbers: data, findings, configuration, software."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

#: What of a dataset must stay, in words: numbers of robots that differ in it cannot be compared.
SCHEMA = {
    "n_commands": "number of commands",
    "n_markers": "number of markers",
    "constant_coordinates": "coordinates that do not move",
    "unit_in_file": "unit in the file",
    "origin": "origin",
}


@dataclass(frozen=True, slots=True)
class Changes:
    """Sentences on what changed, and those among them that a person must look at."""

    sentences: list[str] = field(default_factory=list)
    for_a_person: list[str] = field(default_factory=list)


def changes_between(before: Mapping[str, Any], now: Mapping[str, Any]) -> Changes:
    """What differs between two summaries, with the key `software` (name -> version) where it is known."""
    found = Changes()
    for name, data in now["datasets"].items():
        if name not in before["datasets"]:
            found.sentences.append(f"{name} is new.")
        else:
            _of_dataset(name, before["datasets"][name], data, found)
    found.sentences.extend(f"{name} is gone." for name in before["datasets"] if name not in now["datasets"])
    for path, old, new in _differences(before["configuration"], now["configuration"]):
        found.sentences.append(f"The configuration has {path}: {_text(new)}, before {_text(old)}.")
    software, earlier = now.get("software", {}), before.get("software", {})
    for name in sorted(set(software) | set(earlier)):
        if software.get(name) != earlier.get(name):
            found.sentences.append(f"{name} is {_text(software.get(name))}, before {_text(earlier.get(name))}.")
    return found


def _of_dataset(name: str, before: Mapping[str, Any], now: Mapping[str, Any], found: Changes) -> None:
    from softkin.data.audit.findings import NOTE  # with all checks, which a verdict does not need

    for key, words in SCHEMA.items():
        if before[key] != now[key]:
            found.for_a_person.append(f"{name}: the {words} is {_text(now[key])}, before {_text(before[key])}.")
    known = {(one["code"], one["severity"]) for one in before["findings"]}
    for one in now["findings"]:
        if (one["code"], one["severity"]) not in known and one["severity"] != NOTE:
            found.for_a_person.append(f"{name}: new finding ({one['severity']}): {one['sentence']}")
    if before["content_sha256"] != now["content_sha256"]:
        rows = ", ".join(
            f"{subset} {count}"
            + ("" if count == before["rows"].get(subset) else f" (before {before['rows'].get(subset)})")
            for subset, count in now["rows"].items()
        )
        found.sentences.append(f"{name} has other rows: {rows}.")
    elif before["sha256"] != now["sha256"]:
        found.sentences.append(f"{name} comes from another file with the same rows.")
    if before["deployed"] != now["deployed"]:
        old, new = (
            f"{one['model']} ({one['preset']}) with {one['interval_method']}"
            for one in (before["deployed"], now["deployed"])
        )
        found.sentences.append(f"{name}: deployed is {new}, before {old}.")


def _differences(before: Any, now: Any, path: str = "") -> Iterator[tuple[str, Any, Any]]:
    """(path, before, now) of each value that differs, within mappings."""
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        for key in [*before, *(key for key in now if key not in before)]:
            inner = f"{path}.{key}" if path else str(key)
            yield from _differences(before.get(key), now.get(key), inner)
    elif before != now:
        yield path, before, now


def _text(value: Any) -> str:
    """A value as it stands in a sentence."""
    return "none" if value in (None, [], {}) else str(value)
