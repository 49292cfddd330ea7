from __future__ import annotations

import ast
from functools import cache

import pytest

from tests.conftest import HOUSE
from tests.contract.faults import FAULTS
from tests.contract.faults.fault import Fault
from tools.faults_page import PAGE, page

ALL = [fault for faults in FAULTS.values() for fault in faults]


@cache
def names_in(file: str) -> frozenset[str]:
    tree = ast.parse((HOUSE / "tests" / file).read_text())
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


@pytest.mark.parametrize("fault", ALL, ids=lambda fault: fault.what)
def test_each_fault_has_a_test_that_exists(fault: Fault) -> None:
    file, name = fault.test.split("::")
    assert name.startswith("test_")
    assert name in names_in(file)


def test_there_are_many_and_each_is_another() -> None:
    assert len({fault.what for fault in ALL}) == len(ALL) >= 40


def test_the_page_says_what_the_table_says() -> None:
    assert PAGE.read_text() == page(), "bring it up to date: make faults-page"
