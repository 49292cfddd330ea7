"""What nodes of plain numbers are made of."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from softkin.models.plain.kernels import Node

#: Kinds that are evaluated as quickly as by the estimator that they are of, or quicker; an expanded kernel, too.
QUICK = ("standardised", "polynomial", "detrended", "mean")


def parts_of(node: Any) -> Iterator[Node]:
    """The node itself and all nodes in it that have a `kind`."""
    if isinstance(node, dict):
        if "kind" in node:
            yield node
        for value in node.values():
            yield from parts_of(value)
    elif isinstance(node, list):
        for value in node:
            yield from parts_of(value)


def is_expanded(node: Node) -> bool:
    """Whether a kernel in it is expanded: sums over its points are far less exact."""
    return any("expansion" in part for part in parts_of(node))


def is_quick(node: Node) -> bool:
    """Whether many rows are evaluated as quickly as by the estimator that it is of."""
    return all(part["kind"] in QUICK or "expansion" in part for part in parts_of(node))
