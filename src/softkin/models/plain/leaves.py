"""Which leaf of each tree one row comes to, by numpy alone. Exported Python files hold a copy of this text.

A tree's leaves are numbered from left to right, a bit for each. A row that goes right at a node cannot come to the
leaves on its left: the node's mask clears their bits, and of the bits that all nodes leave, whose thresholds the row
exceeds, the lowest is the row's leaf. What nodes of one feature leave together is worked out once, for each place among
the thresholds: a row is answered by one look-up for each feature, however deep the trees are.

Source: Lucchese et al. (2015), *QuickScorer: a fast algorithm to rank documents with additive ensembles of regression
trees*, SIGIR.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.models.plain.kernels import Node, Values

Whole = np.ndarray[Any, np.dtype[np.int64]]
Masks = np.ndarray[Any, np.dtype[np.uint64]]
#: Bits of a mask, and bytes that masks and their places may take: where trees need more, they are walked.
WORD, MOST_BYTES = 64, 64_000_000
WORDS = (np.uint8, np.uint16, np.uint32, np.uint64)
ONE, ALL = np.uint64(1), ~np.uint64(0)


def leaf_finder(node: Node) -> Callable[[Values], Whole] | None:
    """The function from one row (n_features,) to the `leaf` of each tree, in the shape of `roots`, of a node of trees;
    None where its masks are too many.
    """
    feature, threshold, roots, left = (node[name] for name in ("feature", "threshold", "roots", "left"))
    is_leaf, tree, first, count = in_order(node)
    n_trees, most = roots.size, int(count[roots].max())
    n_words = -(-most // WORD)
    leaves, inner = np.flatnonzero(is_leaf), np.flatnonzero(~is_leaf)
    n_features = int(feature[inner].max(initial=0)) + 1
    inner = inner[np.lexsort((threshold[inner], feature[inner], tree[inner]))]
    group = tree[inner] * n_features + feature[inner]
    n_groups = n_trees * n_features
    edges = [np.unique(threshold[inner[feature[inner] == place]]) for place in range(n_features)]
    n_places = sum(len(one) + 1 for one in edges)
    if 8 * n_words * (len(inner) + n_groups) + 12 * n_places * n_trees > MOST_BYTES:
        return None
    masks, starts = _masks(first[inner], first[inner] + count[left[inner]], group, n_groups, n_words)
    table = np.empty((n_places, n_trees), dtype=np.int32)
    offsets = np.cumsum([0, *(len(one) + 1 for one in edges)])
    for place, (one, offset) in enumerate(zip(edges, offsets, strict=False)):
        own = inner[feature[inner] == place]
        passed = table[offset : offset + len(one) + 1]
        passed[:] = 0
        np.add.at(passed, (np.searchsorted(one, threshold[own]) + 1, tree[own]), 1)
        passed[0] = starts[place::n_features]
        np.cumsum(passed, axis=0, out=passed)
    order = np.lexsort((first[leaves], tree[leaves]))
    found = _found(masks, table, np.searchsorted(tree[leaves[order]], np.arange(n_trees)), most)
    ordered, lists = node["leaf"][leaves[order]], [one.tolist() for one in edges]

    def leaf_of(row: Values) -> Whole:
        places = [
            bisect_left(one, value) + offset
            for one, value, offset in zip(lists, row.tolist(), offsets.tolist(), strict=False)
        ]
        return np.asarray(ordered.take(found(places)).reshape(roots.shape))

    return leaf_of


def in_order(node: Node) -> tuple[Any, Whole, Whole, Whole]:
    """Of each of the nodes of trees: whether it is a leaf, its tree, the number of the first leaf below it, counted
    from the left, and how many leaves there are below it.
    """
    left, right, roots = node["left"], node["right"], node["roots"].ravel()
    is_leaf = left == np.arange(len(left))
    tree, first, count = (np.zeros(len(left), dtype=np.int64) for _ in range(3))
    tree[roots], levels = np.arange(len(roots)), [roots]
    while len(levels[-1]):
        inner = levels[-1][~is_leaf[levels[-1]]]
        tree[left[inner]] = tree[right[inner]] = tree[inner]
        levels.append(np.concatenate([left[inner], right[inner]]))
    count[is_leaf] = 1
    for level in reversed(levels):
        inner = level[~is_leaf[level]]
        count[inner] = count[left[inner]] + count[right[inner]]
    for level in levels:
        inner = level[~is_leaf[level]]
        first[left[inner]], first[right[inner]] = first[inner], first[inner] + count[left[inner]]
    return is_leaf, tree, first, count


def _masks(low: Whole, high: Whole, group: Whole, n_groups: int, n_words: int) -> tuple[Masks, Whole]:
    """Masks (n_masks, n_words) and the place (n_groups,) of the first of each group: all bits, then what the first, the
    first two, ... nodes of the group leave; a node clears the bits from `low` to below `high`.
    """
    sizes = np.bincount(group, minlength=n_groups) + 1
    starts = np.cumsum(sizes) - sizes
    words = WORD * np.arange(n_words)
    below = (_lowest(np.clip(edge[:, None] - words, 0, WORD)) for edge in (low, high))
    masks = np.full((len(low) + n_groups, n_words), ALL)
    masks[np.arange(len(low)) + group + 1] = ~(next(below) ^ next(below))
    for start, size in zip(starts[sizes > 2], sizes[sizes > 2], strict=True):
        np.bitwise_and.accumulate(masks[start : start + size], axis=0, out=masks[start : start + size])
    return masks, starts


def _lowest(n_bits: Whole) -> Masks:
    """Masks whose lowest `n_bits`, 0 to 64, are set."""
    some = (ONE << np.minimum(n_bits, WORD - 1).astype(np.uint64)) - ONE
    return np.where(n_bits == WORD, ALL, some)


def _found(masks: Masks, table: Whole, before: Whole, most: int) -> Callable[[list[int]], Whole]:
    """The function from rows of `table` (n_places, n_trees), which has places of masks, to the leaf of each tree, of
    which `before` (n_trees,) are those of earlier trees.
    """
    n_words = masks.shape[1]
    if n_words == 1:  # the masks themselves, as short as they may be, fit where their places are
        direct = masks[:, 0].astype(next(kind for kind in WORDS if np.iinfo(kind).bits >= most))[table]
        one = direct.dtype.type(1)

        def of_one_word(places: list[int]) -> Whole:
            left = np.bitwise_and.reduce(direct.take(places, axis=0), axis=0)
            return np.asarray(before + np.bitwise_count(~left & (left - one)))

        return of_one_word
    each = n_words * np.arange(len(before))

    def of_words(places: list[int]) -> Whole:
        left = np.bitwise_and.reduce(masks.take(table.take(places, axis=0), axis=0), axis=0)
        word = (left != 0).argmax(axis=1)
        lowest = left.take(each + word)
        return np.asarray(before + WORD * word + np.bitwise_count(~lowest & (lowest - ONE)))

    return of_words
