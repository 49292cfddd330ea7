from __future__ import annotations

from dataclasses import replace

from softkin.uncertainty.export.c_header import c_header
from tests.exported_robots import small


def test_what_it_defines_begins_with_its_name() -> None:
    text = c_header(replace(small("ridge"), dataset="7 arms */"))
    assert "robot_7_arms____predict(const double *command" in text
    assert "#define ROBOT_7_ARMS____COMMANDS 2" in text
    assert "/* 7 arms * /: Polynomial ridge" in text
    assert "@p" not in text.lower().replace("&answer", "")


def test_the_same_table_stands_there_once() -> None:
    text = c_header(small("gp"), [0.9], name="arm")
    tables = [line for line in text.splitlines() if line.startswith("static const")]
    bodies = [text.split(line)[1].split("};")[0] for line in tables]
    assert len(bodies) == len(set(bodies)) > 5
