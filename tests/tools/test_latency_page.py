"""The page of latencies, from what the benchmark printed."""

from __future__ import annotations

import json

from tools.latency_page import PAGE, page, read

ROWS = [
    {"robot": "arm", "way": "model", "where": "inside", "median_ms": 0.25, "p99_ms": 0.5},
    {"robot": "arm", "way": "model", "where": "many rows", "rows": 9, "ms": 30.0, "bare_ms": 20.0},
    {"robot": "arm", "way": "C header", "where": "inside", "median_ms": 0.01},
    {"robot": "arm", "way": "C header", "where": "difference", "mm": 2e-13, "outside_differs": 0},
]


def test_a_line_for_each_way_to_ask() -> None:
    text = page(read(map(json.dumps, ROWS)))
    assert "| arm | model | 0.2500, 0.5000 |  |  |  |  |  |  |" in text
    assert "| arm | C header | 0.0100 |  |  |  |  |  | 2e-13 |" in text
    assert "| arm | 9 | 20 | 30 | 1.50 |" in text
    assert "on 0 of these commands" in text


def test_the_page_is_of_this_form() -> None:
    assert PAGE.read_text(encoding="utf-8").startswith(page([]).split("| --- |")[0])
