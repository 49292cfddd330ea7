"""Write docs/latency.md from what the benchmark of latency measures: python -m tools.latency_page LINES.

LINES is the file that `python -m benchmarks.latency` printed; `make latency-page` makes it from a finished run.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from softkin.core.errors import ResultError, SoftkinError
from softkin.core.files import write_text

PAGE = Path(__file__).parents[1] / "docs" / "latency.md"
HEAD = """# What an answer costs

Made by `make latency-page`: one command with a 90 % interval, in process, on one thread, median and 99 % quantile in ms
of CPU time, of the best of three rounds of 300 (of one of 100, what takes more than 5 ms). Other programs do not count,
but by filling the caches: on a machine that is busy all numbers are larger, and ratios say more. *Bare estimator* is
its `predict` alone, *numpy by hand* the position of a Gaussian process in ten lines. *Loading* is all that a new
process takes until its first answer, imports included, *memory* its largest size then. The C header's time is the mean
of 6,000 commands, by the clock. *Difference* is the largest of positions and bounds to the model, on 10,000 commands
inside and outside.

| robot, model, method | asked | inside | outside | streaming | loading ms | memory MB | size kB | difference mm |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
"""
TAIL = """
Many commands at once, in ms:

| robot, model, method | commands | bare estimator | with intervals | ratio |
| --- | --- | --- | --- | --- |
"""
FOOT = """
`outside` differs between model and exports on {differs} of these commands. *One row against many* is how far the
model's own answer to one command is from its answer to the same command among many. A Gaussian process of a nearly
noiseless robot weighs its rows with large numbers of either sign; it is answered from an expansion that does not
cancel, and exports are: [0040](decisions/0040-kernels-whose-weights-cancel-are-expanded.md).
"""


def page(rows: Sequence[Mapping[str, Any]]) -> str:
    """The page of what was measured."""
    robots = list(dict.fromkeys(row["robot"] for row in rows))
    lines = [HEAD]
    for robot in robots:
        own = [row for row in rows if row["robot"] == robot]
        ways = dict.fromkeys(row["way"] for row in own)
        lines += [_line(robot, way, {row["where"]: row for row in own if row["way"] == way}) for way in ways]
    lines.append(TAIL)
    several = [row for row in rows if row["where"] == "many rows"]
    lines += [
        f"| {row['robot']} | {row['rows']} | {row['bare_ms']:.0f} | {row['ms']:.0f} | {_ratio(row):.2f} |\n"
        for row in several
    ]
    return "".join(lines) + FOOT.format(differs=sum(row.get("outside_differs", 0) for row in rows))


def _line(robot: str, way: str, places: Mapping[str, Mapping[str, Any]]) -> str:
    cells = [_times(places.get(where, {})) for where in ("inside", "outside", "streaming")]
    loading, size, off = (places.get(where, {}) for where in ("load and answer", "size", "difference"))
    cells += [_number(loading, "ms"), _number(loading, "mb"), _number(size, "kb")]
    cells.append(f"{off['mm']:.0e}" if off else "")
    return f"| {robot} | {way} | " + " | ".join(cells) + " |\n"


def _ratio(row: Mapping[str, Any]) -> float:
    return float(row["ms"] / row["bare_ms"])


def _times(row: Mapping[str, Any]) -> str:
    if not row:
        return ""
    return f"{row['median_ms']:.4f}" + (f", {row['p99_ms']:.4f}" if "p99_ms" in row else "")


def _number(row: Mapping[str, Any], key: str) -> str:
    return f"{row[key]:.0f}" if key in row else ""


def read(lines: Iterable[str]) -> list[dict[str, Any]]:
    """What the benchmark printed."""
    return [json.loads(line) for line in lines if line.strip()]


def main() -> int:
    """Write the page; 2, with a sentence, where there are no such lines."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lines", metavar="LINES", type=Path, help="what python -m benchmarks.latency printed")
    parser.add_argument("--page", type=Path, default=PAGE)
    options = parser.parse_args()
    try:
        write_text(options.page, page(_measured(options.lines)))
    except SoftkinError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


def _measured(lines: Path) -> list[dict[str, Any]]:
    """The rows of the file.

    Raises:
        ResultError: there is no such file, or it holds other things.
    """
    try:
        return read(lines.read_text(encoding="utf-8").splitlines())
    except (OSError, ValueError) as error:
        raise ResultError(f"cannot be read: {error}", where=lines, fix="measure anew: make latency-page") from error


if __name__ == "__main__":
    sys.exit(main())
