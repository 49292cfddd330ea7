"""What sides of bounds are multiplied by, in C."""

from __future__ import annotations

import numpy as np

from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.c_text import Tables, number

#: What a side is multiplied by, by the kind of difficulty.
FACTORS = {"none": "1.0", "spread": "difficulty[i]", "distance": "difficulty", "held_out": "difficulty[i]"}


def difficulty_text(numbers: Node, tables: Tables) -> str:
    """Lines that work out the difficulty of the inputs; none where there is none."""
    node, n = numbers["difficulty"], numbers["n_commands"]
    if node["kind"] == "none":
        return ""
    floor = number(node["floor"])
    if node["kind"] == "spread":
        least, count = tables.name(node["least"]), len(node["least"])
        return (
            f"double difficulty[{count}];\nfor (int i = 0; i < {count}; i++) {{\n"
            f"    difficulty[i] = spread[i] + {least}[i];\n"
            f"    if (difficulty[i] < {floor}) difficulty[i] = {floor};\n}}"
        )
    if node["kind"] == "held_out":
        return _near_errors(node, tables, n, floor)
    mean, scale, points, low, high = (tables.name(node[key]) for key in ("mean", "scale", "points", "low", "high"))
    emptiest, unit, least = (number(node[key]) for key in ("emptiest", "unit", "least"))
    neighbours = node["neighbours"]
    return f"""double difficulty, beyond = 0.0, best[{neighbours}], w[{n}];
for (int i = 0; i < {n}; i++) {{
    double apart;
    w[i] = (inputs[i] - {mean}[i]) / {scale}[i];
    apart = w[i] < {low}[i] ? w[i] - {low}[i] : w[i] > {high}[i] ? w[i] - {high}[i] : 0.0;
    beyond += apart * apart;
}}
difficulty = softkin_neighbours(w, {points}, {len(node["points"])}, {n}, {neighbours}, best);
if (difficulty > {emptiest}) difficulty = {emptiest};
if (beyond > 0.0) difficulty = {emptiest} + sqrt(beyond);
difficulty = {least} + difficulty / {unit};
if (difficulty < {floor}) difficulty = {floor};"""


def _near_errors(node: Node, tables: Tables, n: int, floor: str) -> str:
    """The mean error of the nearest rows, by column of errors; the last column is that of constant coordinates."""
    n_points, n_columns = node["errors"].shape
    mean, scale, points = (tables.name(node[key]) for key in ("mean", "scale", "points"))
    norms = tables.name(np.sqrt((node["points"] * node["points"]).sum(axis=1)))
    column = tables.name(np.where(node["column"] < 0, n_columns, node["column"]))
    count = len(node["column"])
    room = int(node["neighbours"].max())
    text = f"""double difficulty[{count}], columns[{n_columns + 1}], w[{n}], reach = 0.0, best[{room}];
for (int i = 0; i < {n}; i++) {{
    w[i] = (inputs[i] - {mean}[i]) / {scale}[i];
    reach += w[i] * w[i];
}}
reach = sqrt(reach);
(void)best;
for (int i = 0; i <= {n_columns}; i++) columns[i] = 1.0;
"""
    for place in np.flatnonzero(node["shares"] > 0):
        share, k = number(node["shares"][place]), int(node["neighbours"][place])
        of, known, d = ("&reach", norms, 1) if node["by_norm"][place] else ("w", points, n)
        errors = tables.name(node["errors"][:, place])
        text += (
            f"columns[{place}] = softkin_near({of}, {known}, {errors}, {n_points}, {d}, {k}, best);\n"
            f"columns[{place}] = {share} * columns[{place}] + (1.0 - {share});\n"
            f"if (columns[{place}] < {number(node['least'])}) columns[{place}] = {number(node['least'])};\n"
        )
    return text + (
        f"for (int i = 0; i < {count}; i++) {{\n    difficulty[i] = columns[{column}[i]];\n"
        f"    if (difficulty[i] < {floor}) difficulty[i] = {floor};\n}}"
    )
