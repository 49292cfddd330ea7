"""Fitted regressors given as plain numbers, evaluated by numpy alone. Exported Python files hold a copy of this text.

A node is a mapping with its `kind`, a key of `KINDS`, and its numbers. Evaluated it answers features (n_rows,
n_features) with targets (n_rows, n_targets) and, where the node has the numbers for it, their spread, else None.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from softkin.models.plain.expansion import expansion
from softkin.models.plain.kernels import SHAPES, Node, Solver, Values, blockwise, prior
from softkin.models.plain.leaves import Whole, leaf_finder
from softkin.models.plain.terms import terms_of_many

Answer = tuple[Values, "Values | None"]
Regressor = Callable[[Values], Answer]
#: Numbers that are held at a time.
NUMBERS_AT_ONCE = 4_000_000
#: The same of polynomials' terms, which are quickest where they stay near the processor.
NUMBERS_OF_TERMS = 100_000


def regressor(node: Node, solver: Solver | None = None) -> Regressor:
    """The regressor that a node describes; `solver` is a faster one than `blockwise`."""
    return KINDS[node["kind"]](node, solver or blockwise)


def _standardised(node: Node, solver: Solver) -> Regressor:
    """Features minus `mean`, divided by `scale`, to the regressor `inner`."""
    inner, mean, scale = regressor(node["inner"], solver), node["mean"], node["scale"]
    return lambda x: inner((x - mean) / scale)


def _polynomial(node: Node, solver: Solver) -> Regressor:
    """Terms are products of the features whose places are in each row of `factors` (n_terms, degree), the place after
    the last feature being 1; standardised by `mean` and `scale`, times `weights`, plus `constant`.
    """
    factors, mean, scale, weights, constant = (
        node[name] for name in ("factors", "mean", "scale", "weights", "constant")
    )
    is_plain = not mean.any() and bool((scale == 1).all())
    is_linear = factors.shape[1] == 1 and np.array_equal(factors[:, 0], np.arange(len(factors)))
    of_one, of_many = np.ascontiguousarray(factors.T), cache(lambda n_features: terms_of_many(factors, n_features))

    def answer(x: Values) -> Answer:
        if is_linear and x.shape[1] == len(factors):
            terms = x
        elif len(x) == 1:
            extended = np.ones(x.shape[1] + 1)
            extended[:-1] = x[0]
            terms = np.multiply.reduce(extended.take(of_one), axis=0)[None]
        else:
            terms = of_many(x.shape[1])(x).T
        return np.asarray((terms if is_plain else (terms - mean) / scale) @ weights + constant), None

    return _in_parts(answer, max(1, NUMBERS_OF_TERMS // factors.size))


def _kernel(node: Node, solver: Solver) -> Regressor:
    """Sum over `points` (n, n_features) of kernel times `weights` (n, n_targets), plus `constant`; the kernel is the
    sum of `terms`. With `factor` (n, n), the lower Cholesky factor of the points' kernel, the standard deviation is
    that of a Gaussian process with `noise`, in units of `factors` (n_targets,). With an `expansion`, targets are those
    of its parts where it holds.
    """
    points, weights, constant = node["points"], node["weights"], node["constant"]
    terms = [SHAPES[term["shape"]](term, points) for term in node["terms"]]
    solved = solver(node["factor"]) if "factor" in node else None

    def answer(x: Values) -> Answer:
        kernel = terms[0](x)
        for term in terms[1:]:
            kernel += term(x)
        targets = kernel @ weights + constant
        if solved is None:
            return targets, None
        variance, shares = np.full(len(x), node["noise"]), solved(kernel.T)
        for term in reversed(node["terms"]):
            variance += prior(term, x)
        variance -= np.einsum("ij,ji->i", shares.T, shares)
        return targets, np.sqrt(np.maximum(variance, 0.0))[:, None] * node["factors"]

    step = max(1, NUMBERS_AT_ONCE // (points.size + len(points)))
    return _in_parts(_expanded(node, answer) if "expansion" in node else answer, step)


def _expanded(node: Node, direct: Regressor) -> Regressor:
    """The same, with the targets of the expansion where it holds; without it there, where no spread is asked for."""
    of_powers, constant, has_spread = expansion(node["expansion"]), node["constant"], "factor" in node

    def answer(x: Values) -> Answer:
        targets, holds = of_powers(x)
        targets += constant
        if has_spread:
            summed, spread = direct(x)
            return np.where(holds[:, None], targets, summed), spread
        if not holds.all():
            targets[~holds] = direct(x[~holds])[0]
        return targets, None

    return answer


def _network(node: Node, solver: Solver) -> Regressor:
    """Layers of `weights` (fan_in, fan_out) and `biases`, with `activation` between them. With `factor`, the lower
    Cholesky factor of the precision of the last layer, the spread is sqrt(1 + leverage) times `noise` (n_targets,).
    """
    weights, biases, activate = node["weights"], node["biases"], ACTIVATIONS[node["activation"]]
    solved = solver(node["factor"]) if "factor" in node else None

    def answer(x: Values) -> Answer:
        for matrix, bias in zip(weights[:-1], biases[:-1], strict=True):
            x = activate(x @ matrix + bias)
        targets = x @ weights[-1] + biases[-1]
        if solved is None:
            return targets, None
        leverage = np.square(solved(np.vstack([x.T, np.ones(len(x))]))).sum(axis=0)
        return targets, np.sqrt(1.0 + leverage)[:, None] * node["noise"]

    return answer


def _mean(node: Node, solver: Solver) -> Regressor:
    """The mean of `members` by `shares`, which add up to 1; the spread is that of the mixture."""
    if _are_alike(node["members"]):
        return _networks(node)
    members, shares = [regressor(member, solver) for member in node["members"]], node["shares"]

    def answer(x: Values) -> Answer:
        answers = [member(x) for member in members]
        targets = np.tensordot(shares, np.stack([one for one, _ in answers]), 1)
        spreads = [spread for _, spread in answers if spread is not None]
        if len(spreads) < len(members):
            return targets, None
        apart = np.square(np.stack([one for one, _ in answers]) - targets)
        return targets, np.sqrt(np.tensordot(shares, np.square(np.stack(spreads)) + apart, 1))

    return answer


def _are_alike(members: list[Node]) -> bool:
    """Whether they are networks of the same layers, which are told no spread of."""
    shapes = [
        (member["activation"], *(matrix.shape for matrix in member["weights"]))
        for member in members
        if member["kind"] == "network" and "factor" not in member
    ]
    return len(shapes) == len(members) and len(set(shapes)) == 1


def _networks(node: Node) -> Regressor:
    """The mean of networks that are alike, all in one product for each layer."""
    members, shares = node["members"], node["shares"]
    activate, layers = ACTIVATIONS[members[0]["activation"]], range(len(members[0]["weights"]))
    weights = [np.stack([member["weights"][layer] for member in members]) for layer in layers]
    biases = [np.stack([member["biases"][layer] for member in members])[:, None] for layer in layers]

    def answer(x: Values) -> Answer:
        for matrices, bias in zip(weights[:-1], biases[:-1], strict=True):
            x = activate(x @ matrices + bias)
        targets = x @ weights[-1] + biases[-1]
        return np.dot(shares, targets.reshape(len(targets), -1)).reshape(targets.shape[1:]), None

    return _in_parts(answer, max(1, NUMBERS_AT_ONCE // (4 * max(matrices[:, 0].size for matrices in weights))))


def _detrended(node: Node, solver: Solver) -> Regressor:
    """The regressor `trend` plus `scale` times the regressor `rest`."""
    trend, rest, scale = regressor(node["trend"], solver), regressor(node["rest"], solver), node["scale"]

    def answer(x: Values) -> Answer:
        targets, spread = rest(x)
        return trend(x)[0] + targets * scale, None if spread is None else spread * scale

    return answer


def _trees(node: Node, solver: Solver) -> Regressor:
    """Trees from `roots`; at a node the way is `left` where the feature of its place is at most its `threshold`, else
    `right`; a leaf leads to itself. Its `leaf` is a row of `values` (n_leaves, n_columns).

    A tree of all targets has a column for each, and answers are the mean of the trees plus `constant`; `has_spread`
    says that their standard deviation is the spread. Else `roots` are (n_targets, n_rounds), values have one column,
    and answers are `constant` plus the sum over rounds. `single`: features, with `single_sums` sums too, have 32 bits.
    """
    roots, feature, threshold, left, right = (node[name] for name in ("roots", "feature", "threshold", "left", "right"))
    leaf, values, constant = node["leaf"], node["values"], node["constant"]
    finder = cache(lambda: leaf_finder(node))

    def leaves(x: Values) -> Whole:
        if len(x) == 1 and (of_one := finder()) is not None:
            return of_one(x[0])[None]
        places = np.tile(roots, (len(x), *[1] * roots.ndim))
        rows = np.arange(len(x)).reshape(-1, *[1] * roots.ndim)
        for _ in range(node["depth"]):
            goes_left = x[rows, feature[places]] <= threshold[places]
            places = np.where(goes_left, left[places], right[places])
        return np.asarray(leaf[places])

    def answer(x: Values) -> Answer:
        if node["single"]:
            x = x.astype(np.float32).astype(np.float64)
        found = values.take(leaves(x), axis=0)
        if roots.ndim == 1:
            spread = found.std(axis=1) if node["has_spread"] else None
            return np.add.reduce(found, axis=1) / roots.size + constant, spread
        if not node["single_sums"]:
            return found[..., 0].sum(axis=2) + constant, None
        terms = np.empty((*found.shape[:2], 1 + found.shape[2]), dtype=np.float32)
        terms[..., 0], terms[..., 1:] = constant, found[..., 0]
        sums = np.add.accumulate(terms, axis=2)
        return sums[..., -1].astype(np.float64), None

    return _in_parts(answer, max(1, NUMBERS_AT_ONCE // (4 * roots.size * values.shape[1])))


def _in_parts(answer: Regressor, n_rows: int) -> Regressor:
    """The same, at most `n_rows` rows at a time."""

    def answer_all(x: Values) -> Answer:
        if len(x) <= n_rows:
            return answer(x)
        parts = [answer(x[start : start + n_rows]) for start in range(0, len(x), n_rows)]
        spreads = [spread for _, spread in parts if spread is not None]
        return np.concatenate([targets for targets, _ in parts]), np.concatenate(spreads) if spreads else None

    return answer_all


ACTIVATIONS: dict[str, Callable[[Values], Values]] = {
    "tanh": np.tanh,
    "logistic": lambda x: 0.5 * (1.0 + np.tanh(0.5 * x)),
    "relu": lambda x: np.maximum(x, 0.0),
    "identity": lambda x: x,
}
KINDS: dict[str, Callable[[Node, Solver], Regressor]] = {
    "standardised": _standardised,
    "polynomial": _polynomial,
    "kernel": _kernel,
    "network": _network,
    "mean": _mean,
    "detrended": _detrended,
    "trees": _trees,
}
