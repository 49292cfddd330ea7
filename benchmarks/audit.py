"""Measure the time and memory of an audit of a large made-up table.

    python -m benchmarks.audit [--rows 1000000] [--commands 6] [--markers 10] [--only-write] [--table FILE]

Writes a table of a smooth robot with noise (or takes `--table`), audits it and prints the seconds and the largest
memory that the process held. Making the table takes memory of its own: to measure the audit alone, write it first with
`--only-write --table FILE`, then give the file.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from softkin.core.files import read_json
from softkin.core.samples import SUBSETS, Samples
from softkin.data.audit.data_card import audit
from softkin.data.table import to_table, write_table

SHARES = (0.56, 0.07, 0.07, 0.30)


def made_up(n_rows: int, n_commands: int, n_markers: int) -> dict[str, Samples]:
    """Sines of mixed commands, 100 mm wide, noise 0.1 mm; extrapolation has the largest command norms."""
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (n_rows, n_commands))
    order = np.argsort(np.linalg.norm(commands, axis=1))
    inner = rng.permutation(order[: round(n_rows * sum(SHARES[:3]))])
    rows = np.split(np.append(inner, order[len(inner) :]), np.cumsum([round(n_rows * share) for share in SHARES[:3]]))
    mixing = rng.standard_normal((n_commands, 3 * n_markers)) / n_commands
    positions = 100 * np.sin(commands @ mixing) + 0.1 * rng.standard_normal((n_rows, 3 * n_markers))
    return {subset: Samples(commands[part], positions[part]) for subset, part in zip(SUBSETS, rows, strict=True)}


def main() -> int:
    """Print seconds and memory; the exit status is 1 beyond a minute or 2 GB."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--commands", type=int, default=6)
    parser.add_argument("--markers", type=int, default=10)
    parser.add_argument("--only-write", action="store_true")
    parser.add_argument("--table", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        table = options.table or Path(folder) / "table.parquet"
        if options.only_write or not options.table:
            write_table(to_table(made_up(options.rows, options.commands, options.markers)), table)
        if options.only_write:
            return 0
        start = time.perf_counter()
        card = Path(folder) / "card.json"
        readable = Path(folder) / "card.md"
        audit(table, dataset="large", title="large", position_unit="mm", data_card=card, readable=readable)
        seconds = time.perf_counter() - start
        n_rows = sum(subset["rows"] for subset in read_json(card)["subsets"].values())
    gigabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2
    print(f"{n_rows} rows: {seconds:.1f} s, {gigabytes:.2f} GB at most")
    return int(seconds > 60 or gigabytes > 2)


if __name__ == "__main__":
    sys.exit(main())
