from __future__ import annotations

from softkin.models.plain.kernels import Node
from softkin.models.plain.parts import is_expanded, is_quick, parts_of

POLYNOMIAL: Node = {"kind": "polynomial"}
TREES: Node = {"kind": "trees"}
SUMMED: Node = {"kind": "kernel"}
EXPANDED = SUMMED | {"expansion": [{"powers": 1}]}


def within(*members: Node) -> Node:
    return {"kind": "standardised", "inner": {"kind": "mean", "members": list(members), "shares": [0.5, 0.5]}}


def test_parts_are_all_nodes_within() -> None:
    assert [part["kind"] for part in parts_of(within(POLYNOMIAL, EXPANDED))] == [
        "standardised",
        "mean",
        "polynomial",
        "kernel",
    ]


def test_polynomials_and_expanded_kernels_are_quick() -> None:
    assert is_quick(within(POLYNOMIAL, EXPANDED))
    assert not is_quick(within(POLYNOMIAL, SUMMED))
    assert not is_quick(within(POLYNOMIAL, TREES))


def test_a_kernel_anywhere_within_counts_as_expanded() -> None:
    assert is_expanded(within(TREES, EXPANDED))
    assert not is_expanded(within(POLYNOMIAL, SUMMED))
