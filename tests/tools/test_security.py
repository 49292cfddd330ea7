"""Each promise of SECURITY.md names the tests that hold it."""

from __future__ import annotations

import ast
import re

from tests.conftest import HOUSE

TEXT = (HOUSE / "SECURITY.md").read_text()


def test_each_promise_has_a_test_that_exists() -> None:
    promises = [line for line in TEXT.splitlines() if line.startswith("| ") and line.split("|")[1].strip() != "promise"]
    promises = [line for line in promises if not line.startswith("| ---")]
    assert len(promises) > 10
    for line in promises:
        named = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", line)
        assert named, line
        for file, name in named:
            tree = ast.parse((HOUSE / file).read_text())
            assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}, f"{file}::{name}"
