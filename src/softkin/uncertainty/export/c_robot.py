"""What of a robot is written in C around its regressor: memory, target space, what lies outside, bounds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.c_difficulty import FACTORS, difficulty_text
from softkin.uncertainty.export.c_nodes import c_function
from softkin.uncertainty.export.c_text import Tables, number


def space_function(node: Node, tables: Tables, n_coordinates: int) -> str:
    """The name of the function from targets y and spreads s to positions and spreads in mm."""
    arguments = "const double *y, const double *s, double *position, double *spread"
    body = SPACE_WRITERS[node["space"]](node, tables, n_coordinates)
    return tables.function(arguments, body, what="Targets to positions, in mm.")


def _scaled(node: Node, tables: Tables, n_coordinates: int) -> str:
    constants, kept, mean, scale = (tables.name(node[name]) for name in ("constants", "kept", "mean", "scale"))
    body = (
        f"for (int i = 0; i < {n_coordinates}; i++) {{\n    position[i] = {constants}[i];\n    spread[i] = 0.0;\n}}\n"
    )
    body += f"for (int t = 0; t < {len(node['kept'])}; t++) {{\n"
    body += f"    position[{kept}[t]] = y[t] * {scale}[t] + {mean}[t];\n"
    return body + f"    spread[{kept}[t]] = s[t] * {scale}[t];\n}}"


def _arcs(node: Node, tables: Tables, n_coordinates: int) -> str:
    n_moving, n_arcs = len(node["moving"]), node["n_arcs"]
    arcs = space_function(node["arcs"], tables, 3 * n_moving)
    constants, moving = tables.name(node["constants"]), tables.name(node["moving"])
    axes, origin = tables.name(node["axes"]), tables.name(node["origin"])
    body = f"double arc[{3 * n_moving}], of_arc[{3 * n_moving}], end[3];\n"
    body += (
        f"for (int i = 0; i < {n_coordinates}; i++) {{\n    position[i] = {constants}[i];\n    spread[i] = 0.0;\n}}\n"
    )
    body += f"{arcs}(y, s, arc, of_arc);\nfor (int m = 0; m < {n_moving}; m++) {{\n"
    body += "    softkin_arc_end(arc + 3 * m, end);\n    for (int r = 0; r < 3; r++)\n"
    body += f"        position[3 * {moving}[m] + r] = softkin_dot({axes} + 3 * r, end, 3) + {origin}[r];\n"
    body += f"    softkin_arc_spread(arc + 3 * m, of_arc + 3 * m, {axes}, spread + 3 * {moving}[m]);\n}}\n"
    if "others" not in node:
        return body
    n, others = len(node["near_constant"]), space_function(node["others"], tables, len(node["near_constant"]))
    places = tables.name(node["near_constant"])
    body += f"double other[{n}], of_other[{n}];\n{others}(y + {n_arcs}, s + {n_arcs}, other, of_other);\n"
    body += f"for (int i = 0; i < {n}; i++) {{\n    position[{places}[i]] = other[i];\n"
    return body + f"    spread[{places}[i]] = of_other[i];\n}}"


SPACE_WRITERS: dict[str, Callable[[Node, Tables, int], str]] = {"scaled": _scaled, "arcs": _arcs}


def inputs_text(numbers: Node, tables: Tables, n_inputs: int) -> str:
    """Functions for what a robot remembers: at rest, after a command, the zero of a session."""
    n, memory = numbers["n_commands"], numbers["memory"]
    if memory is None:
        return (
            "static inline int @p_rest(double *inputs, int session) {\n"
            f"    for (int i = 0; i < {n}; i++) inputs[i] = 0.0;\n    return session == 0;\n}}\n"
            "static inline void @p_send(double *inputs, const double *command) {\n"
            f"    for (int i = 0; i < {n}; i++) inputs[i] = command[i];\n}}\n"
            "static inline double @p_zero(const double *inputs, int coordinate) {\n"
            "    (void)inputs;\n    (void)coordinate;\n    return 0.0;\n}"
        )
    rest, halves, sessions, zeros = (tables.name(memory[name]) for name in ("rest", "halves", "sessions", "zeros"))
    n_widths, (n_sessions, n_coordinates) = len(memory["halves"]), memory["zeros"].shape
    return f"""/* Inputs: the command, the one before, {n_widths} play operators, the session. */
static inline int @p_session(double session) {{
    for (int i = 0; i < {n_sessions}; i++)
        if ({sessions}[i] == session) return i;
    return -1;
}}
static inline int @p_rest(double *inputs, int session) {{
    for (int i = 0; i < {n_inputs - 1}; i++) inputs[i] = {rest}[i % {n}];
    inputs[{n_inputs - 1}] = session;
    return session == 0 || @p_session((double)session) >= 0;
}}
static inline void @p_send(double *inputs, const double *command) {{
    for (int i = 0; i < {n}; i++) {{
        inputs[{n} + i] = inputs[i];
        inputs[i] = command[i];
    }}
    for (int i = 0; i < {n_widths * n}; i++) {{
        double *play = inputs + {2 * n} + i;
        double low = command[i % {n}] - {halves}[i], high = command[i % {n}] + {halves}[i];
        *play = *play < low ? low : *play > high ? high : *play;
    }}
}}
static inline double @p_zero(const double *inputs, int coordinate) {{
    int place = @p_session(inputs[{n_inputs - 1}]);
    return place < 0 ? 0.0 : {zeros}[place * {n_coordinates} + coordinate];
}}"""


def n_features(member: Node, n_commands: int) -> int:
    """Features that the regressor of a member is given."""
    return int(n_commands * (1 + int(member["has_step"]) + len(member["widths"])))


def features_function(member: Node, tables: Tables, n: int) -> str:
    """The name of the function from inputs to the features of a member, of `n` commands."""
    starts = [n] * member["has_step"] + [n * (2 + int(width)) for width in member["widths"]]
    lines = [f"for (int i = 0; i < {n}; i++) features[i] = inputs[i];"]
    for place, start in enumerate(starts):
        own = n * (1 + place)
        lines.append(f"for (int i = 0; i < {n}; i++) features[{own} + i] = inputs[i] - inputs[{start} + i];")
    arguments = "const double *inputs, double *features"
    return tables.function(arguments, "\n".join(lines), what="What the regressor is given.")


def outside_text(numbers: Node, tables: Tables) -> str:
    """Lines that say whether the inputs lie outside, and their norm."""
    n, places = numbers["n_commands"], numbers["surroundings"]
    mean, scale, points = (tables.name(places[name]) for name in ("mean", "scale", "points"))
    varies, centre, norm_scale = (tables.name(places[name]) for name in ("varies", "centre", "norm_scale"))
    gap = number(places["gap"])
    n_points, n_varies = len(places["points"]), len(places["varies"])
    return f"""    {{
        double z[{n}], part, sum = 0.0;
        for (int i = 0; i < {n}; i++) z[i] = (inputs[i] - {mean}[i]) / {scale}[i];
        for (int i = 0; i < {n_varies}; i++) {{
            part = (inputs[{varies}[i]] - {centre}[i]) / {norm_scale}[i];
            sum += part * part;
        }}
        norm = sqrt(sum);
        answer->outside = norm > {number(places["radius"])};
        if (!answer->outside) answer->outside = softkin_far(z, {points}, {n_points}, {n}, {gap});
    }}"""


def bounds_text(numbers: Node, tables: Tables, n: int) -> str:
    """Lines that put bounds around the position."""
    sides = tables.name(np.stack([table["sides"] for table in numbers["tables"]])[:, 0])
    start = f"{sides}[(level * {n} + i) * 2 + side]"
    lines = [difficulty_text(numbers, tables)]
    factor = FACTORS[numbers["difficulty"]["kind"]]
    lines.append(
        f"for (int i = 0; i < {n}; i++)\n    for (int side = 0; side < 2; side++) sides[i][side] = {start} * {factor};"
    )
    if numbers["tables"][0]["zero"] is not None:
        zero = tables.name(np.stack([table["zero"][0] for table in numbers["tables"]]))
        lines.append(
            f"if (@p_session(inputs[@P_INPUTS - 1]) < 0)\n    for (int i = 0; i < {n}; i++)\n"
            "        for (int side = 0; side < 2; side++) {\n            double *one = &sides[i][side];\n"
            f"            if (*one != 0.0) *one = copysign(hypot(*one, {zero}[level * {n} + i]), *one);\n        }}"
        )
    lines.append(
        f"for (int i = 0; i < {n}; i++) {{\n    answer->lower[i] = answer->position[i] + sides[i][0];\n"
        "    answer->upper[i] = answer->position[i] + sides[i][1];\n}"
    )
    lines.append("(void)spread;")
    if numbers["growths"] is not None:
        lines.append(_growth(numbers, tables, n))
    return "\n".join("    " + line for text in lines if text for line in text.splitlines())


def failures_text(numbers: Node, tables: Tables, n: int) -> str:
    """Lines that say whether the pose may fail, and put bounds around failed poses, too, where it may; none where no
    failures are known that commands foretell.
    """
    node = numbers["failures"]
    if node is None:
        return ""
    lower, upper, least = (tables.name(node[name]) for name in ("lower", "upper", "least"))
    return f"""    {{
        double probability[1], unused[1];
        {c_function(node["tree"], tables)}(inputs, probability, unused);
        answer->failure_probability = probability[0];
        answer->may_fail = probability[0] > {least}[level];
        for (int i = 0; answer->may_fail && i < {n}; i++) {{
            if ({lower}[i] < answer->lower[i]) answer->lower[i] = {lower}[i];
            if ({upper}[i] > answer->upper[i]) answer->upper[i] = {upper}[i];
        }}
    }}"""


def _growth(numbers: Node, tables: Tables, n: int) -> str:
    stored = numbers["tables"]
    limits = tables.name(np.stack([table["limits"][0] for table in stored]))
    radius = number(numbers["surroundings"]["radius"])
    body = f"if (answer->outside) {{\n    double x = log(norm > {radius} ? norm / {radius} : 1.0);\n"
    body += f"    for (int i = 0; i < {n}; i++) {{\n        double widest = {limits}[level * {n} + i], near, grown;\n"
    for place, growth in enumerate(numbers["growths"]):
        largest = tables.name(np.stack([table["growth_limits"][place][0] for table in stored]))
        floor, slope, bend = (tables.name(np.broadcast_to(growth[key], n)) for key in ("floor", "slope", "bend"))
        reach = number(growth["reach"])
        body += f"        near = x < {reach} ? x : {reach};\n"
        body += f"        grown = near * {slope}[i] + near * near * {bend}[i];\n"
        body += f"        grown += (x - near) * ({slope}[i] + 2 * {bend}[i] * {reach});\n"
        body += f"        grown = {largest}[level * {n} + i] * exp({floor}[i] + grown);\n"
        body += "        if (grown > widest) widest = grown;\n"
    lower, upper = "answer->position[i] - widest", "answer->position[i] + widest"
    if numbers["has_spread"]:
        body += f"        if ({lower} < answer->lower[i]) answer->lower[i] = {lower};\n"
        return body + f"        if ({upper} > answer->upper[i]) answer->upper[i] = {upper};\n    }}\n}}"
    return body + f"        answer->lower[i] = {lower};\n        answer->upper[i] = {upper};\n    }}\n}}"
