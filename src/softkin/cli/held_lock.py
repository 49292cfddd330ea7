"""A lock that the system frees when the process that holds it ends, and a note beside it that says which that is."""

from __future__ import annotations

import os
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from filelock import FileLock, Timeout

from softkin.core.errors import DataError
from softkin.core.files import read_json, write_json


@dataclass(frozen=True, slots=True)
class HeldLock:
    """A lock, and the file (JSON) that says which process holds it since when."""

    lock: FileLock
    note: Path

    @classmethod
    def of(cls, lock: Path, note: str) -> HeldLock:
        """That of the file `lock`, not taken yet; the note of that name lies beside it."""
        return cls(FileLock(lock), lock.with_name(note))

    def take(self, patience: float = 0.0) -> bool:
        """Take the lock for this process; whether it was free within `patience` seconds."""
        try:
            self.lock.acquire(timeout=patience)
        except Timeout:
            return False
        write_json(self.note, {"pid": os.getpid(), "since": datetime.now(UTC).isoformat(timespec="seconds")})
        return True

    def release(self) -> None:
        """Free the lock before the process ends."""
        self.lock.release()

    def holder(self) -> str:
        """Who holds the lock since when, in words."""
        try:
            known = dict(read_json(self.note)) if self.note.exists() else {}
        except DataError:  # torn by the kill of a process before
            known = {}
        return f"process {known.get('pid', 'unknown')} since {known.get('since', 'an unknown time')}"
