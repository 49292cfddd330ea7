"""Check the configuration's files, for what YAML and JSON let through: a key that stands twice, of which the last would
count; 010, which YAML reads as 8; 1:30, which it reads as 90.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import yaml

from softkin.core.errors import ConfigError
from softkin.core.strict_json import MAX_DEPTH, NotStrictJson, parse_json

#: Reads a large file of datasets ten times faster; PyYAML's own where it was built without libyaml.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_STANDARD = "tag:yaml.org,2002:"
_NUMBERS = (f"{_STANDARD}int", f"{_STANDARD}float")
#: Numbers that YAML 1.1 reads otherwise than people do: octal and sexagesimal ones.
_MISREAD = re.compile(r"[-+]?(0[0-9_]+$|.*:)")
_MAX_DIGITS = 300


def check_config_files(paths: Iterable[str | Path]) -> None:
    """Check that each file of the configuration (YAML, or JSON) can be read, and in one way only.

    Raises:
        ConfigError: a file cannot be read, is neither YAML nor JSON, has no keys at its top level, a key twice, or a
            number that is easily misread; names the file and the line.
    """
    for path in paths:
        text = _text(path)
        if not (text.lstrip().startswith("{") and _is_json(text, path)):
            _check_yaml(text, path)


def _text(path: str | Path) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ConfigError(
            f"not UTF-8 text (byte {error.start})", where=path, fix="save the file as plain text in UTF-8"
        ) from error
    except OSError as error:
        raise ConfigError(
            f"cannot be read: {(error.strerror or str(error)).lower()}",
            where=path,
            fix="name a file that is there and may be read",
        ) from error


def _is_json(text: str, path: str | Path) -> bool:
    """Whether the text is JSON, which Snakemake tries first; what is not may be YAML in braces."""
    try:
        parse_json(text)
    except NotStrictJson as error:
        if str(error).startswith("not JSON"):
            return False
        raise ConfigError(str(error), where=path, fix="correct the file") from error
    return True


def _check_yaml(text: str, path: str | Path) -> None:
    try:
        if _is_deep(text):  # composing it would end the process
            raise ConfigError("nested too deeply", where=path, fix="correct the file")
        top = yaml.compose(text, Loader=LOADER)
    except yaml.MarkedYAMLError as error:
        number = error.problem_mark.line if error.problem_mark else 0
        line = next(iter(text.splitlines()[number : number + 1]), "")
        fix = "correct it or the line above; blank after a colon, quotes around text with : or #, brackets in pairs"
        raise ConfigError(
            f"not readable as YAML: {error.problem}" + (f": '{line.strip()[:60]}'" if line.strip() else ""),
            where=f"{path}, line {number + 1}",
            fix="indent by blanks, not by tabs" if line.startswith("\t") else fix,
        ) from error
    except yaml.YAMLError as error:
        reason = " ".join(str(error).split())[:200]
        raise ConfigError(f"not readable as YAML: {reason}", where=path, fix="correct the file") from error
    if not isinstance(top, yaml.MappingNode):
        raise ConfigError(
            "no keys at its top level", where=path, fix="write keys and values as config/README.md explains"
        )
    for node, what, fix in _problems(top):
        raise ConfigError(what, where=f"{path}, line {node.start_mark.line + 1}", fix=fix)


def _is_deep(text: str) -> bool:
    depth = 0
    for event in yaml.parse(text, Loader=LOADER):
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > MAX_DEPTH:
            return True
    return False


def _problems(top: yaml.Node) -> Iterator[tuple[yaml.Node, str, str]]:
    """(where, what is wrong, fix) of each problem in the nodes of a document; an alias is looked at once."""
    waiting, seen = [top], {id(top)}
    while waiting:
        node = waiting.pop()
        if isinstance(node, yaml.ScalarNode):
            yield from _problems_of_scalar(node)
            continue
        if not node.tag.startswith(_STANDARD) or "python/" in node.tag:
            yield node, f"the tag {node.tag}, which the configuration does not know", "delete the tag"
        inner = node.value
        if isinstance(node, yaml.MappingNode):
            names = set()
            for key in (key for key, _ in node.value if isinstance(key, yaml.ScalarNode)):
                if (key.tag, key.value) in names:
                    fix = "keep one of the two; without a word the second would replace the first"
                    yield key, f"the key '{key.value[:60]}' stands twice", fix
                names.add((key.tag, key.value))
            inner = [part for pair in node.value for part in pair]
        fresh = [item for item in reversed(inner) if id(item) not in seen]
        seen.update(map(id, fresh))
        waiting += fresh


def _problems_of_scalar(node: yaml.ScalarNode) -> Iterator[tuple[yaml.Node, str, str]]:
    if not node.tag.startswith(_STANDARD) or "python/" in node.tag:
        yield node, f"the tag {node.tag}, which the configuration does not know", "delete the tag"
    elif node.tag in _NUMBERS and _MISREAD.match(node.value):
        fix = "write it without a leading zero or colon, or in quotes where it is text"
        yield node, f"{node.value}, which YAML reads as another number", fix
    elif node.tag in _NUMBERS and len(node.value) > _MAX_DIGITS:
        yield node, f"a number of {len(node.value)} digits", "write a number that can be meant"
