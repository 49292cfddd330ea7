"""The documents: what they quote is what softkin prints, what they link to is there, and they stay short."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.cli.one_run import OneRun
from softkin.core.configuration import check_configuration
from softkin.core.errors import SoftkinError
from softkin.data.reachability import warning
from softkin.data.readers import table_file
from softkin.data.retrieve import retrieve
from softkin.models import MODELS
from softkin.tracking.store import client_of
from tests.conftest import HOUSE
from tests.workbooks import write_workbook

README = HOUSE / "README.md"
DOCUMENTS = [README, HOUSE / "CONTRIBUTING.md", HOUSE / "CHANGELOG.md", HOUSE / "config" / "README.md"]
DOCUMENTS += [HOUSE / "SECURITY.md"]
DOCUMENTS += sorted((HOUSE / "docs").rglob("*.md"))
DECISIONS = sorted((HOUSE / "docs" / "decisions").glob("[0-9]*.md"))


def test_the_readme_is_a_page() -> None:
    lines = README.read_text().splitlines()
    assert len(lines) <= 120
    assert max(map(len, lines)) <= 120


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(HOUSE)))
def test_links_lead_somewhere(document: Path) -> None:
    text = document.read_text()
    targets = [*re.findall(r"\]\(([^)\s]+)\)", text), *re.findall(r"^\[[^\]]+\]: (\S+)$", text, re.MULTILINE)]
    missing = [link for link in targets if "://" not in link and not (document.parent / link.split("#")[0]).exists()]
    assert not missing


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(HOUSE)))
def test_files_that_are_named_exist(document: Path) -> None:
    folders = "src|tests|tools|docs|config|workflow|templates|benchmarks|resources"
    named = re.findall(rf"`((?:{folders})/[\w./-]+)`", document.read_text())
    assert not [path for path in named if not (HOUSE / path).exists()]


def unreachable(folder: Path) -> None:
    retrieve(
        dataset="finger", file="FINGER.json", urls=[], sha256="0" * 64, destination=folder / "raw", mirror=str(folder)
    )


def misspelt(_: Path) -> None:
    files = ("config.yaml", "datasets.yaml")
    config: dict[str, Any] = {}
    for file in files:
        config |= yaml.safe_load((HOUSE / "config" / file).read_text())
    config["tuning"]["n_trails"] = 5
    check_configuration(config, HOUSE / "workflow" / "schemas" / "config.schema.yaml", {"models": MODELS})


def table_of(content: bytes) -> Callable[[Path], None]:
    """Reads a robot's own file of this content."""

    def read(folder: Path) -> None:
        (folder / "arm.csv").write_bytes(content)
        entry = {"file": "arm.csv", "commands": ["u1"], "positions": ["x", "y", "z"], "position_unit": "mm"}
        table_file.read(folder / "arm.csv", dataset="arm", source=entry | {"split": {"method": "random"}})

    return read


def workbook_of_two_sheets(folder: Path) -> None:
    sheets: dict[str, Any] = {"a": [["u1"], [1]], "b": [["x"], [1]]}
    table_of(write_workbook(folder / "arm.xlsx", sheets).read_bytes())(folder)


def lost_store(_: Path) -> None:
    client_of("sqlite:///mlflow.db")


HEADER = b"u1,x,y,z\n"
ROWS = [b"%d,%d.5,2.5,3.5" % (row, row) for row in range(12)]


#: In the order of the README.
def second_run(folder: Path) -> None:
    """One run has the folder, and another one wants it."""
    first, second = OneRun.of(folder), OneRun.of(folder)
    first.take()
    try:
        second.take(patience=0.1)
    finally:
        first.lock.release()


ERRORS = [
    None,
    unreachable,
    misspelt,
    workbook_of_two_sheets,
    table_of(HEADER + b"1,2,3,4\nn/a,2,3,4\n"),
    table_of(HEADER + b"\n".join(ROWS)),
    second_run,
    lost_store,
]


def quoted() -> list[str]:
    """What the README's troubleshooting says is printed."""
    table = README.read_text().split("## When something goes wrong")[1].split("\n## ")[0]
    return re.findall(r"^\| `(.*?)` \|", table, re.MULTILINE)


def test_errors_of_the_readme_are_those_that_are_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert len(quoted()) == len(ERRORS)
    for text, provoke in zip(quoted(), ERRORS, strict=True):
        if provoke is not None:
            with pytest.raises(SoftkinError) as caught:
                provoke(tmp_path)
            assert text in str(caught.value)
            assert caught.value.fix
    assert quoted()[0] in warning({"finger": []})


def test_every_make_target_that_is_named_exists() -> None:
    targets = set(re.findall(r"^([\w-]+):", (HOUSE / "Makefile").read_text(), re.MULTILINE))
    for document in DOCUMENTS:
        code = re.findall(r"`make ([\w -]+)`|^    make ([\w-]+)", document.read_text(), re.MULTILINE)
        named = {word for pair in code for word in " ".join(pair).split()}
        assert named <= targets, f"{document}: {named - targets}"


def test_decisions_are_short_numbered_and_listed() -> None:
    assert [int(path.name[:4]) for path in DECISIONS] == list(range(1, len(DECISIONS) + 1))
    listed = re.findall(r"^- \[(\d{4})\]\(\1-", (HOUSE / "docs" / "decisions" / "README.md").read_text(), re.MULTILINE)
    assert listed == [path.name[:4] for path in DECISIONS]
    for path in DECISIONS:
        text = path.read_text()
        assert len(text.splitlines()) < 60, path.name
        assert text.startswith(f"# {path.name[:4]}. ")
        assert {"## Decision", "## Consequences"} <= set(text.splitlines()), path.name
