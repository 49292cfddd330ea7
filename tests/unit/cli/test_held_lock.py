from __future__ import annotations

import os
from pathlib import Path

import pytest

from softkin.cli.held_lock import HeldLock


def test_one_holds_it_until_it_is_released(tmp_path: Path) -> None:
    first, second = (HeldLock.of(tmp_path / "a.lock", "a.json") for _ in range(2))
    assert first.take()
    assert not second.take()
    assert second.holder().startswith(f"process {os.getpid()} since 20")
    first.release()
    assert second.take(patience=1.0)


@pytest.mark.parametrize("note", [None, "", '{"pid": 7, "si'])
def test_a_note_that_is_torn_or_not_there_says_nothing(tmp_path: Path, note: str | None) -> None:
    if note is not None:
        (tmp_path / "a.json").write_text(note)
    assert HeldLock.of(tmp_path / "a.lock", "a.json").holder() == "process unknown since an unknown time"
