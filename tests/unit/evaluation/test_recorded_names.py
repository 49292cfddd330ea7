"""Names in the table of scores in time."""

from __future__ import annotations

import subprocess
import sys

from softkin.evaluation import recorded_names


def test_every_name_is_one_of_its_own() -> None:
    names = [value for name, value in vars(recorded_names).items() if name.isupper() and isinstance(value, str)]
    assert len(set(names)) == len(names) == 8
    assert len(set(recorded_names.COLUMNS)) == len(recorded_names.COLUMNS)


def test_they_cost_no_import() -> None:
    code = "import sys, softkin.evaluation.recorded_names; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numpy", "pandas", "sklearn"} & set(loaded)
