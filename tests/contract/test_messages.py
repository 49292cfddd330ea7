"""Every configuration key that a message or a docstring of softkin names is one of the schema."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.core.schema_files import read_schema
from tests.conftest import HOUSE

SOURCES = sorted((HOUSE / "src" / "softkin").rglob("*.py"))
SCHEMA = read_schema(HOUSE / "workflow" / "schemas" / "config.schema.yaml")
#: What follows a section and a dot without being a key: suffixes of files.
SUFFIXES = {"py", "smk", "yaml", "csv", "json", "md"}
#: A command to type may follow a colon, and no key stands before it.
COMMAND = re.compile(r"(make|python|snakemake|pip) ")


def objects(node: Any, name: str = "") -> Iterator[tuple[str, dict[str, Any], bool]]:
    """(name, properties, whether any other key is allowed) of every object of the schema; the whole has no name."""
    if "properties" in node or "additionalProperties" in node:
        others = node.get("additionalProperties")
        yield name, node.get("properties", {}), isinstance(others, dict)
        for key, value in node.get("properties", {}).items():
            yield from objects(value, key)
        if isinstance(others, dict):
            yield from objects(others, name)


PROPERTIES: dict[str, dict[str, Any]] = {}
OPEN = set()
for section, properties, is_open in objects(SCHEMA):
    PROPERTIES[section] = PROPERTIES.get(section, {}) | properties
    if is_open and not properties:
        OPEN.add(section)
KEYS = {key: value for properties in PROPERTIES.values() for key, value in properties.items()}


def words_in(value: Any) -> set[str]:
    """All strings in a configuration, and its keys."""
    if isinstance(value, dict):
        return set(value) | {word for part in value.values() for word in words_in(part)}
    return {word for part in value for word in words_in(part)} if isinstance(value, list) else {str(value)}


CONFIGURED = words_in(yaml.safe_load((HOUSE / "config" / "config.yaml").read_text(encoding="utf-8")))


def values_of(key: str) -> set[str] | None:
    """The values that the schema allows for a key; None where it allows any."""
    schema = KEYS[key].get("items", KEYS[key])
    return set(map(str, schema["enum"])) if "enum" in schema else None


def unknown_dotted(text: str) -> list[str]:
    """`section.key` in a text where the schema has the section without the key."""
    sections = "|".join(name for name in PROPERTIES if name and name not in OPEN)
    pairs = re.findall(rf"(?<![\w./])({sections})\.([a-z_]+)\b(?!\()", text)
    return [f"{name}.{key}" for name, key in pairs if key not in PROPERTIES[name] and key not in SUFFIXES]


def unknown_in_fix(text: str) -> list[str]:
    """Keys that a fix names, as `key: value`, between backticks or with an underscore, and that the schema has not."""
    wrong = []
    for key, value in re.findall(r"(?<![\w/.`])([a-z_]+): (?=[\[{]*(\w[\w ]*))", text):
        if COMMAND.match(value):
            continue
        word = value.split()[0]
        allowed = values_of(key) if key in KEYS else set()
        if allowed is not None and word not in allowed:
            wrong.append(f"{key}: {word}")
    names = re.findall(r"`([a-z_]+)`", text) + re.findall(r"(?<![\w./{}-])[a-z]+(?:_[a-z]+)+(?![\w./(-])", text)
    subsets = PROPERTIES["rows"]
    return wrong + [name for name in names if name not in KEYS and name not in CONFIGURED and name not in subsets]


def text_of(node: ast.AST) -> str:
    """The text of a string or of an f-string, with {} for what is filled in; empty for anything else."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    if isinstance(node, ast.JoinedStr):
        return "".join(text_of(part) if isinstance(part, ast.Constant) else "{}" for part in node.values)
    return ""


def strings(path: Path) -> Iterator[str]:
    """All strings of a source file, docstrings among them."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if text := text_of(node):
            yield text


def fixes(path: Path) -> Iterator[str]:
    """The texts that a source file passes as `fix`, or assigns to a variable of that name."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.keyword) and node.arg == "fix":
            yield text_of(node.value)
        if isinstance(node, ast.Assign) and [getattr(target, "id", "") for target in node.targets] == ["fix"]:
            yield text_of(node.value)


def test_every_section_and_key_that_a_text_names_is_in_the_schema() -> None:
    wrong = {str(path.relative_to(HOUSE)): unknown_dotted(text) for path in SOURCES for text in strings(path)}
    assert not {path: names for path, names in wrong.items() if names}


def test_every_key_that_a_fix_names_is_in_the_schema() -> None:
    texts = [(path.relative_to(HOUSE).as_posix(), text) for path in SOURCES for text in fixes(path)]
    wrong = [(path, name) for path, text in texts for name in unknown_in_fix(text)]
    assert not wrong


def test_the_fixes_of_the_source_are_seen() -> None:
    texts = [text for path in SOURCES for text in fixes(path)]
    assert len(texts) > 40
    for key in ("tuning.n_folds", "objective: interpolation", "split: {method: random}", "`data_mirror`"):
        assert any(key in text for text in texts), key


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("lower tuning.n_folds and refitting.n_folds", []),
        ("set tuning.objective to interpolation", ["tuning.objective"]),
        ("as in tuning.py or shells.outer_shells()", []),
        ("max_fit_rows.svr holds the rows", []),
        ("sources.split or split.columns", ["split.columns"]),
    ],
)
def test_a_section_without_the_key_is_seen(text: str, names: list[str]) -> None:
    assert unknown_dotted(text) == names


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("write objective: interpolation and leave outer out of presets", []),
        ("write objective: interpolate", ["objective: interpolate"]),
        ("write objektive: interpolation", ["objektive: interpolation"]),
        ("split: {method: column, column: ...}", []),
        ("split: {method: columns}", ["method: columns"]),
        ("target_spaces: [cartesian]", []),
        ("target_spaces: [cartesisch]", ["target_spaces: cartesisch"]),
        ("make it again from results/: make store", []),
        ("correct `rows` of the entry, or `dimension`", ["dimension"]),
        ("add scp_mapie to interval_methods", []),
        ("raise max_rows_of_a_subset", ["max_rows_of_a_subset"]),
    ],
)
def test_a_fix_with_a_key_that_is_none_is_seen(text: str, names: list[str]) -> None:
    assert unknown_in_fix(text) == names
