"""Notes below a subset's results: leaks first, then what the dataset's entry says of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from softkin.core.samples import SUBSETS
from softkin.data.audit.findings import leak_notes


def subset_notes(card: Mapping[str, Any], notes_of_entry: Mapping[str, str]) -> dict[str, str]:
    """What a reader of a subset's results must know, by subset, from the data card and the entry's `notes`; subsets
    without a note are left out.
    """
    leaks = leak_notes(card)
    notes = {subset: f"{leaks.get(subset, '')} {notes_of_entry.get(subset, '')}".strip() for subset in SUBSETS}
    return {subset: note for subset, note in notes.items() if note}
