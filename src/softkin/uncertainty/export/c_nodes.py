"""Registry of how nodes of plain numbers are written in C: a function each, from features to targets and spread."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.c_text import Tables, number

ARGUMENTS = "const double *x, double *y, double *s"
ACTIVATIONS = {"identity": 0, "tanh": 1, "logistic": 2, "relu": 3}


def c_function(node: Node, tables: Tables) -> str:
    """The name of the function of a node; its spread `s` is filled in where the node has the numbers for it."""
    body = WRITERS[node["kind"]](node, tables)
    return tables.function(ARGUMENTS, body, what=f"Of kind {node['kind']}: features x, targets y, their spread s.")


def n_targets(node: Node) -> int:
    """Targets of a node."""
    if node["kind"] == "network":
        return len(node["biases"][-1])
    inner = {"standardised": "inner", "detrended": "trend"}.get(node["kind"])
    if inner:
        return n_targets(node[inner])
    return n_targets(node["members"][0]) if node["kind"] == "mean" else len(node["constant"])


def has_spread(node: Node) -> bool:
    """Whether a node has the numbers of its spread."""
    if node["kind"] == "mean":
        return all(map(has_spread, node["members"]))
    inner = {"standardised": "inner", "detrended": "rest"}.get(node["kind"])
    return has_spread(node[inner]) if inner else bool(node.get("has_spread")) or "factor" in node


def _started(node: Node, tables: Tables) -> str:
    n = n_targets(node)
    return f"for (int t = 0; t < {n}; t++) y[t] = {tables.name(node['constant'])}[t];\n"


def _standardised(node: Node, tables: Tables) -> str:
    n, inner = len(node["mean"]), c_function(node["inner"], tables)
    mean, scale = tables.name(node["mean"]), tables.name(node["scale"])
    return f"double z[{n}];\nfor (int i = 0; i < {n}; i++) z[i] = (x[i] - {mean}[i]) / {scale}[i];\n{inner}(z, y, s);"


def _polynomial(node: Node, tables: Tables) -> str:
    n_terms, degree = node["factors"].shape
    numbers = [tables.name(node[name]) for name in ("factors", "mean", "scale", "weights")]
    factors, mean, scale, weights = numbers
    call = f"{factors}, {n_terms}, {degree}, {mean}, {scale}, {weights}, {n_targets(node)}, y"
    return f"(void)s;\n{_started(node, tables)}softkin_polynomial(x, {node['n_features']}, {call});"


def _kernel(node: Node, tables: Tables) -> str:
    n, d = node["points"].shape
    body = _started(node, tables) + (_expansion(node, tables) if "expansion" in node else "")
    body += f"double k[{n}], z[{d}];\n(void)s;\n(void)z;\nfor (int i = 0; i < {n}; i++) k[i] = 0.0;\n"
    prior = [number(node["noise"])] if "factor" in node else []
    for term in node["terms"]:
        shape, constant, points, at = term["shape"], number(term["constant"]), node["points"], "x"
        extra = "".join(f", {number(term[key])}" for key in ("rate", "offset") if key in term)
        if "power" in term:
            extra += f", {term['power'] if shape == 'product' else number(term['power'])}"
        if shape == "product":
            inner = f"{number(term['rate'])} * softkin_dot(x, x, {d}) + {number(term['offset'])}"
            prior.append(f"{constant} * pow({inner}, {term['power']})")
        else:
            prior.append(constant)
            if (term["lengths"] != 1).any():
                points, at = points / term["lengths"], "z"
                body += f"for (int i = 0; i < {d}; i++) z[i] = x[i] / {tables.name(term['lengths'])}[i];\n"
        body += f"softkin_{shape}({at}, {tables.name(points)}, {n}, {d}, {constant}{extra}, k);\n"
    body += "if (!near) " if "expansion" in node else ""
    body += f"softkin_weigh(k, {tables.name(node['weights'])}, {n}, {n_targets(node)}, y);\n"
    if "factor" not in node:
        return body
    packed = np.asarray(node["factor"])[np.tril_indices(n)]
    body += f"double variance = {' + '.join(prior)} - softkin_explained(k, {tables.name(packed)}, {n});\n"
    body += "double deviation = variance > 0.0 ? sqrt(variance) : 0.0;\n"
    return body + f"for (int t = 0; t < {n_targets(node)}; t++) s[t] = deviation * {tables.name(node['factors'])}[t];"


def _expansion(node: Node, tables: Tables) -> str:
    """Lines that add what the powers say where they hold, and say whether they do, `near`."""
    d, checks, calls, room = node["points"].shape[1], [], "", 1
    for part in node["expansion"]:
        lengths, powers, weights = (tables.name(part[name]) for name in ("lengths", "powers", "weights"))
        n_terms, degree = len(part["powers"]), int(part["powers"].max())
        room = max(room, d * (degree + 1))
        checks.append(f"softkin_within(x, {lengths}, {d}, {number(part['reach'])})")
        which = f"{powers}, {n_terms}, {degree}, {weights}, {n_targets(node)}"
        calls += f"    softkin_powers(x, {lengths}, {d}, {number(part['rate'])}, {which}, table, y);\n"
    body = f"int near = {' && '.join(checks)};\nif (near) {{\n    double table[{room}];\n{calls}"
    return body + ("}\n" if "factor" in node else "    return;\n}\n")


def _network(node: Node, tables: Tables) -> str:
    body, at, last = "(void)s;\n", "x", len(node["weights"]) - 1
    for place, (weights, biases) in enumerate(zip(node["weights"], node["biases"], strict=True)):
        n_in, n_out = weights.shape
        to = "y" if place == last else f"h{place}"
        if place < last:
            body += f"double h{place}[{n_out + 1}];\n"
        activation = 0 if place == last else ACTIVATIONS[node["activation"]]
        layer = f"{n_in}, {tables.name(weights)}, {tables.name(biases)}, {n_out}, {activation}, {to}"
        body += f"softkin_layer({at}, {layer});\n"
        at = to if place < last else at
    if "factor" not in node:
        return body
    n = len(node["factor"])
    packed = tables.name(np.asarray(node["factor"])[np.tril_indices(n)])
    body += f"{at}[{n - 1}] = 1.0;\ndouble deviation = sqrt(1.0 + softkin_explained({at}, {packed}, {n}));\n"
    return body + f"for (int t = 0; t < {n_targets(node)}; t++) s[t] = deviation * {tables.name(node['noise'])}[t];"


def _mean(node: Node, tables: Tables) -> str:
    n, count, shares = n_targets(node), len(node["members"]), tables.name(node["shares"])
    body = f"double each[{count}][{n}], squares[{n}];\nfor (int t = 0; t < {n}; t++) y[t] = squares[t] = 0.0;\n"
    for place, member in enumerate(node["members"]):
        share = f"{shares}[{place}]"
        body += f"{c_function(member, tables)}(x, each[{place}], s);\n"
        body += f"for (int t = 0; t < {n}; t++) y[t] += {share} * each[{place}][t];\n"
        if has_spread(node):
            body += f"for (int t = 0; t < {n}; t++) squares[t] += {share} * s[t] * s[t];\n"
    if not has_spread(node):
        return body + "(void)squares;"
    body += f"for (int m = 0; m < {count}; m++)\n    for (int t = 0; t < {n}; t++) "
    body += f"squares[t] += {shares}[m] * (each[m][t] - y[t]) * (each[m][t] - y[t]);\n"
    return body + f"for (int t = 0; t < {n}; t++) s[t] = sqrt(squares[t]);"


def _detrended(node: Node, tables: Tables) -> str:
    n, scale = n_targets(node), tables.name(np.broadcast_to(node["scale"], n_targets(node)))
    trend, rest = (c_function(node[name], tables) for name in ("trend", "rest"))
    body = f"double left[{n}];\n{trend}(x, y, s);\n{rest}(x, left, s);\n"
    body += f"for (int t = 0; t < {n}; t++) y[t] += left[t] * {scale}[t];\n"
    return body + (f"for (int t = 0; t < {n}; t++) s[t] *= {scale}[t];" if has_spread(node) else "")


def _trees(node: Node, tables: Tables) -> str:
    # Leaves lead to themselves, whatever is compared there.
    finite = np.where(np.isinf(node["threshold"]), 0.0, node["threshold"])
    used = (node["feature"], finite, node["left"], node["right"], node["leaf"])
    names = [tables.name(values) for values in used]
    roots, values, constant = (tables.name(node[name]) for name in ("roots", "values", "constant"))
    n, n_features = n_targets(node), int(node["feature"].max()) + 1
    cast = "(double)(float)" if node["single"] else ""
    body = f"double f[{n_features}];\n(void)s;\nfor (int i = 0; i < {n_features}; i++) f[i] = {cast}x[i];\n"
    found = f"softkin_leaf(f, {roots}[%s], {', '.join(names)})"
    if node["roots"].ndim == 2:
        rounds, kind = node["roots"].shape[1], "float" if node["single_sums"] else "double"
        body += f"for (int t = 0; t < {n}; t++) {{\n    {kind} sum = ({kind}){constant}[t];\n"
        at = found % f"t * {rounds} + r"
        return body + f"    for (int r = 0; r < {rounds}; r++) sum += ({kind}){values}[{at}];\n    y[t] = sum;\n}}"
    count = node["roots"].size
    body += f"int leaves[{count}];\nfor (int r = 0; r < {count}; r++) leaves[r] = {found % 'r'};\n"
    body += f"for (int t = 0; t < {n}; t++) {{\n    double mean = 0.0, squares = 0.0;\n"
    value = f"{values}[(size_t)leaves[r] * {n} + (size_t)t]"
    body += f"    for (int r = 0; r < {count}; r++) mean += {value};\n    mean /= {count};\n"
    if node["has_spread"]:
        body += f"    for (int r = 0; r < {count}; r++) squares += ({value} - mean) * ({value} - mean);\n"
    body += f"    y[t] = mean + {constant}[t];\n"
    return body + (f"    s[t] = sqrt(squares / {count});\n}}" if node["has_spread"] else "    (void)squares;\n}")


WRITERS: dict[str, Callable[[Node, Tables], str]] = {
    "standardised": _standardised,
    "polynomial": _polynomial,
    "kernel": _kernel,
    "network": _network,
    "mean": _mean,
    "detrended": _detrended,
    "trees": _trees,
}
