from __future__ import annotations

import re
import subprocess
import sys
import time

from softkin.core.terminal import CLOCK


def test_lines_begin_with_the_time_of_day() -> None:
    assert re.fullmatch(r"[0-2]\d:[0-5]\d:[0-5]\d", time.strftime(CLOCK))


def test_the_screen_of_a_run_keeps_pythons_own_collections() -> None:
    """A plan of a thousand datasets takes its memory; only jobs look for dead objects more rarely."""
    told = "import gc, softkin.cli.watching.view; print(gc.get_threshold()[0] < 20_000)"
    assert subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True).stdout == "True\n"
