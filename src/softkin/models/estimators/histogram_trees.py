"""Trees of histograms as scikit-learn grows them, equal to the bit: what it makes anew for each tree is made once.

Its trees are grown by Python around compiled parts: which rows go where, histograms, the best split. These parts are
called as scikit-learn calls them. For each tree it makes them anew, copies gradients, looks at clocks, and writes nodes
number by number; on the few hundred rows of a trial that took as long as the parts themselves.

Source: scikit-learn 1.9, `TreeGrower`, whose order of splits, and so of random draws, this keeps.
"""

from __future__ import annotations

from heapq import heappop, heappush
from math import ceil
from typing import Any

import numpy as np
from sklearn.ensemble._hist_gradient_boosting.common import G_H_DTYPE
from sklearn.ensemble._hist_gradient_boosting.histogram import HistogramBuilder
from sklearn.ensemble._hist_gradient_boosting.splitting import Splitter

#: The least sum of hessians of a node, which scikit-learn fixes: here all are 1.
LEAST_HESSIAN = 1e-3


class Node:
    """A node while its tree grows: its rows are a view of the splitter's; `split` is None where none was sought."""

    __slots__ = ("depth", "gradients", "hessians", "histograms", "left", "n_rows", "right", "rows", "split", "value")

    def __init__(self, depth: int, rows: Any, n_rows: int, gradients: float, hessians: float, value: float) -> None:
        self.depth, self.rows, self.n_rows = depth, rows, n_rows
        self.gradients, self.hessians, self.value = gradients, hessians, value
        self.histograms: Any = None
        self.split: Any = None
        self.left: Node | None = None
        self.right: Node | None = None

    def __lt__(self, other: Node) -> bool:
        """The heap gives the node of the largest gain first."""
        return bool(self.split.gain > other.split.gain)


class Grower:
    """Grows one tree after the other on the same binned rows, by gradients that are written into `gradients`.

    Parameters:
        binned: bins of the rows (n_rows, n_features), in Fortran's order.
        mapper: of the bins.
        max_depth: of a tree.
        min_samples_leaf: rows of a leaf at least.
        max_features: share of the features that each split chooses from.
        l2_regularization: as of scikit-learn.
        rng: draws these features.
        threads: threads at most.
    """

    def __init__(
        self,
        binned: Any,
        mapper: Any,
        *,
        max_depth: int | None,
        min_samples_leaf: int,
        max_features: float,
        l2_regularization: float,
        rng: np.random.Generator,
        threads: int,
    ) -> None:
        n_rows, n_features = binned.shape
        self.n_bins, self.thresholds = mapper.n_bins_non_missing_.tolist(), mapper.bin_thresholds_
        self.max_depth, self.least = max_depth, min_samples_leaf
        self.gradients, self.ordered = np.empty(n_rows, dtype=G_H_DTYPE), np.empty(n_rows, dtype=G_H_DTYPE)
        self.builder = HistogramBuilder(
            binned, mapper.n_bins, self.gradients, np.ones(1, dtype=G_H_DTYPE), True, threads
        )
        self.builder.ordered_gradients = self.ordered
        none = np.zeros(n_features, dtype=np.uint8)
        # Where each split chooses from all features nothing need be drawn.
        chooses = ceil(max_features * n_features) < n_features
        self.splitter = Splitter(
            X_binned=binned,
            n_bins_non_missing=mapper.n_bins_non_missing_,
            missing_values_bin_idx=mapper.n_bins - 1,
            has_missing_values=none,
            is_categorical=none,
            monotonic_cst=none.astype(np.int8),
            l2_regularization=l2_regularization,
            min_hessian_to_split=LEAST_HESSIAN,
            min_samples_leaf=min_samples_leaf,
            min_gain_to_split=0.0,
            hessians_are_constant=True,
            feature_fraction_per_split=max_features if chooses else 1.0,
            rng=rng,
            n_threads=threads,
        )
        self.first_rows = np.arange(n_rows, dtype=np.uint32)
        self.rows = self.first_rows.copy()
        self.splitter.partition = self.rows

    def grow(self) -> Node:
        """The root of a tree; the rows of its leaves are `rows`, leaf by leaf from left to right."""
        self.rows[:] = self.first_rows
        self.ordered[:] = self.gradients
        waiting: list[Node] = []
        histograms = self.builder.compute_histograms_brute(self.rows)
        n_rows = len(self.rows)
        gradients = histograms.base["sum_gradients"][0].sum()
        root = Node(0, self.rows, n_rows, gradients, float(n_rows), 0)
        if n_rows >= 2 * self.least:
            root.histograms = histograms
            self._seek(root, waiting)
        while waiting:
            self._split(heappop(waiting), waiting)
        return root

    def _seek(self, node: Node, waiting: list[Node]) -> None:
        """Find the best split of a node; with one it waits for being split, else it is a leaf."""
        node.split = self.splitter.find_node_split(
            node.n_rows, node.histograms, node.gradients, node.hessians, node.value
        )
        if node.split.gain > 0:
            heappush(waiting, node)
        else:
            node.histograms = None

    def _split(self, node: Node, waiting: list[Node]) -> None:
        """Split a node, and seek the splits of its children."""
        split, depth = node.split, node.depth + 1
        left_rows, right_rows, _ = self.splitter.split_indices(split, node.rows)
        n_left, n_right = split.n_samples_left, split.n_samples_right
        node.left = left = Node(
            depth, left_rows, n_left, split.sum_gradient_left, split.sum_hessian_left, split.value_left
        )
        node.right = right = Node(
            depth, right_rows, n_right, split.sum_gradient_right, split.sum_hessian_right, split.value_right
        )
        histograms, node.histograms = node.histograms, None
        if depth == self.max_depth:
            return
        seek_left, seek_right = n_left >= 2 * self.least, n_right >= 2 * self.least
        if not (seek_left or seek_right):
            return
        small, large = (left, right) if n_left < n_right else (right, left)
        small.histograms = self.builder.compute_histograms_brute(small.rows)
        large.histograms = self.builder.compute_histograms_subtraction(histograms, small.histograms)
        if seek_left:
            self._seek(left, waiting)
        if seek_right:
            self._seek(right, waiting)

    def records(self, node: Node, found: list[Any]) -> None:
        """Append the nodes below and with `node`, itself first, as scikit-learn's predictor stores them."""
        split, left, right = node.split, node.left, node.right
        gain = -1 if split is None else split.gain
        if left is None or right is None:
            found.append((node.value, node.n_rows, 0, 0.0, 0, 0, 0, gain, node.depth, 1, 0, 0, 0))
            return
        feature, place, own = split.feature_idx, split.bin_idx, len(found)
        threshold = np.inf if place == self.n_bins[feature] - 1 else self.thresholds[feature][place]
        to_left = left.n_rows > right.n_rows
        found.append(None)
        self.records(left, found)
        after = len(found)
        self.records(right, found)
        found[own] = (
            node.value, node.n_rows, feature, threshold, to_left, own + 1, after, gain, node.depth, 0, place, 0, 0
        )  # fmt: skip


def leaves_of(node: Node) -> list[Node]:
    """The leaves below a node from left to right; itself where it is one."""
    if node.left is None or node.right is None:
        return [node]
    return [*leaves_of(node.left), *leaves_of(node.right)]
