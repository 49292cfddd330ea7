"""The journal of a study: a file of one record (JSON) a line, appended in the order of events.

Every beginning of a journal that ends with a whole line is the journal of the same study at an earlier moment. A record
that a killed process or a power cut left half written is therefore cut off, and the study goes on from the moment
before it.
"""

from __future__ import annotations

import json
import logging
import os
from pathlib import Path
from typing import Any

logger = logging.getLogger("softkin")


def is_of(path: Path, name: str) -> bool:
    """Whether `path` is the journal of the study `name`; where it is another file, the log says so."""
    if not path.exists():
        return False
    with path.open("rb") as file:
        first = _record(file.readline())
    if first is None:
        logger.warning("%s is no journal of a study: a new study replaces it", path)
    elif first.get("study_name") != name:
        logger.info("%s is a study of other data, settings, code or libraries: a new one replaces it", path)
    else:
        return True
    return False


def heal(path: Path) -> None:
    """Cut off what follows the last readable record of a journal, and say so in the log.

    Unreadable is a last line without an end, or one that is no record; with it goes whatever follows.
    """
    kept = 0
    with path.open("rb") as file:
        for line in file:
            if _record(line) is None:
                break
            kept += len(line)
    lost = path.stat().st_size - kept
    if lost:
        logger.warning("a record in %s is torn: its last %d bytes are cut off, and the study goes on", path, lost)
        os.truncate(path, kept)


def _record(line: bytes) -> dict[str, Any] | None:
    """The record of a line, None where it is torn."""
    if not line.endswith(b"\n"):
        return None
    try:
        record = json.loads(line)
    except ValueError:
        return None
    return record if isinstance(record, dict) and {"op_code", "worker_id"} <= record.keys() else None
