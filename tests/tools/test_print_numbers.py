from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.tools.small_run import write_small_run
from tools.print_numbers import main

SECTIONS = [
    "printed cells",
    "deployed, on extrapolation",
    "studies by target space",
    "curvature over Cartesian, extrapolation RMSE",
    "the forest on extrapolation",
    "intervals chosen",
    "around the paper's GB",
    "the Gaussian process' own",
    "jointly, deployed",
    "alarms, deployed",
    "auto and plain, extrapolation",
    "auto and plain, test",
    "everything else, extrapolation",
]


def test_every_section_is_printed_from_the_tables(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    write_small_run(tmp_path)
    monkeypatch.setattr(sys, "argv", ["print_numbers", "--results", str(tmp_path)])
    main()
    text = capsys.readouterr().out
    assert [line[3:] for line in text.splitlines() if line.startswith("## ")] == SECTIONS
    assert "less than 1 in 4 of 4" in text
    printed, deployed = text.split("## ")[1:3]
    assert ["mae_mm", "4.28", "4.56"] in [line.split()[-3:] for line in printed.splitlines()]
    assert ["gp", "tuned", "curvature", "2", "1", "0.1", "0.5"] in [line.split()[-7:] for line in deployed.splitlines()]
