from __future__ import annotations

import ast
from dataclasses import replace

from softkin.uncertainty.export.python_file import python_file
from tests.exported_robots import small


def test_nothing_is_defined_twice_and_nothing_of_softkin_is_imported() -> None:
    tree = ast.parse(python_file(small("ridge"), name="arm"))
    names = [node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
    assert len(names) == len(set(names)) > 30
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    imported |= {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    of_python = {"__future__", "base64", "bisect", "collections.abc", "functools", "json", "typing", "zlib"}
    assert imported == of_python | {"numpy"}


def test_a_name_cannot_end_the_text_around_it() -> None:
    text = python_file(replace(small("ridge"), dataset='arm""" \\ "'), name="arm")
    assert (ast.get_docstring(ast.parse(text)) or "").startswith("arm''' / ': Polynomial ridge")
