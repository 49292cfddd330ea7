"""The regular expressions of `imported_code` against Python's own parser, and the closure of imports."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from softkin.core import imported_code as module
from softkin.core.imported_code import (
    CHOSEN_FROM,
    LEFT_OUT,
    PACKAGE,
    WITHOUT_EFFECT,
    file_of,
    imported_code,
    imported_modules,
)
from tests.conftest import HOUSE

SCRIPTS = sorted((HOUSE / "workflow" / "scripts").glob("*.py"))


def modules_of(package: Path) -> dict[str, Path]:
    """Dotted name -> file of every module and package."""
    names = {}
    for path in package.rglob("*.py"):
        parts = path.relative_to(package.parent).with_suffix("").parts
        names[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return names


MODULES = modules_of(PACKAGE)


def imported_when_run(node: ast.AST) -> Iterator[str]:
    """Modules of softkin that a syntax tree imports, but for `if TYPE_CHECKING`, whose `else` counts."""
    if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
        for other in node.orelse:
            yield from imported_when_run(other)
        return
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names if alias.name.split(".")[0] == "softkin")
    if isinstance(node, ast.ImportFrom):
        assert node.level == 0, "relative imports are not read"
        if (node.module or "").split(".")[0] == "softkin":
            for alias in node.names:
                name = f"{node.module}.{alias.name}"
                yield name if name in MODULES else str(node.module)
    for child in ast.iter_child_nodes(node):
        yield from imported_when_run(child)


@pytest.mark.parametrize(
    "folder", sorted({path.parent for path in [*MODULES.values(), *SCRIPTS]}), ids=lambda f: f.name
)
def test_what_is_read_off_a_file_is_what_python_parses(folder: Path) -> None:
    for path in sorted(folder.glob("*.py")):
        expected = set(imported_when_run(ast.parse(path.read_text(encoding="utf-8"))))
        assert set(imported_modules(path)) == expected, path


def test_every_name_leads_to_its_file() -> None:
    assert {name: file_of(name) for name in MODULES} == MODULES
    for path in [*MODULES.values(), *SCRIPTS]:
        assert set(imported_modules(path)) <= set(MODULES), path


def test_exceptions_are_modules_and_registries_are_packages() -> None:
    assert set(MODULES) >= LEFT_OUT
    assert not set(WITHOUT_EFFECT) & CHOSEN_FROM
    registries = CHOSEN_FROM - {"softkin.data.audit.cleaning"}  # which an entry of config/datasets.yaml asks for
    assert all(file_of(name).name == "__init__.py" for name in registries)
    assert all(WITHOUT_EFFECT.values())


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_closure_is_closed_and_holds_no_exception(script: Path) -> None:
    files = imported_code(script)
    assert files == sorted(set(files))
    assert set(files) <= set(MODULES.values())
    assert not {file_of(name) for name in LEFT_OUT} & set(files)
    for path in files:
        assert set(imported_code(path)) <= set(files), path
    assert imported_code(*files) == files


def test_a_reader_is_decided_by_the_files_that_it_reads_with() -> None:
    def names(reader: str) -> set[str]:
        return {
            path.relative_to(PACKAGE).as_posix() for path in imported_code(file_of(f"softkin.data.readers.{reader}"))
        }

    # Whatever kind of table the file turns out to be.
    tables = {
        "table_file",
        "columns",
        "delimited_text",
        "bad_rows",
        "arrow_columns",
        "c3d_file",
        "excel_workbook",
        "feather_file",
        "file_bundle",
        "joined_tables",
        "partner_rows",
        "several_files",
        "header_rows",
        "nested_values",
        "stamped_table",
        "stacked_tables",
        "hdf5_file",
        "ndi_export",
        "optional_library",
        "published_json",
        "parquet_columns",
        "text_encoding",
        "tracker_text",
        "vicon_export",
        "complete_rows",
        "table_formats",
    }
    tables |= {
        "memory_table",
        "text_layout",
        "named_arrays",
        "numpy_file",
        "matlab_file",
        "json_records",
        "motive_export",
    }
    expected = {f"data/readers/{name}.py" for name in tables} | {"data/split.py", "core/samples.py"}
    expected |= {
        "data/own_files.py",
        "data/times.py",
        "core/units.py",
        "data/blocks.py",
        "data/missing_values.py",
        "core/recording.py",
        "data/recordings.py",
        "data/split_in_time.py",
        "data/orientation.py",
        "core/rotations.py",
    }
    assert names("table_file") == expected
    assert names("published_json") == {"data/readers/published_json.py", "core/samples.py", "core/recording.py"}
    assert "data/standins/cosserat_rod.py" in names("simulated")


MADE_UP = {
    "__init__.py": "",
    "core/__init__.py": "",
    "core/errors.py": "",
    "core/rows.py": "import numpy as np\n",
    "data/__init__.py": "",
    "data/table.py": "from softkin.core.errors import DataError\nfrom softkin.core.rows import chunks\n",
    "data/unused.py": "",
    "models/__init__.py": "from softkin.models import lasso, svr\n",
    "models/lasso.py": "",
    "models/svr.py": "from softkin.core import rows\n",
    "reporting/__init__.py": "",
    "reporting/page.py": "",
    "training/__init__.py": "",
    "training/late.py": "import softkin.training.fit\n",
    "training/fit.py": """\
from __future__ import annotations

from typing import TYPE_CHECKING

from softkin.data.table import (
    read,  # and what it reads
    write as put,
)
from softkin.models import MODELS

if TYPE_CHECKING:
    from softkin.data import unused

    from softkin.reporting.page import (
        page,
    )

#: from softkin.reporting import page


def fit() -> None:
    import softkin.training.late as late
""",
}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A made-up package in the place of softkin, and a script outside it."""
    for name, text in MADE_UP.items():
        path = tmp_path / "softkin" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    (tmp_path / "script.py").write_text("from softkin.training.fit import fit\n", encoding="utf-8")
    monkeypatch.setattr(module, "PACKAGE", tmp_path / "softkin")
    file_of.cache_clear()
    yield tmp_path / "softkin"
    file_of.cache_clear()


def names_of(package: Path, *sources: Path) -> list[str]:
    return [path.relative_to(package).as_posix() for path in imported_code(*sources)]


def test_the_closure_follows_imports_also_inside_functions_and_around_circles(package: Path) -> None:
    script = package.parent / "script.py"
    expected = ["core/rows.py", "data/table.py", "training/fit.py", "training/late.py"]
    assert names_of(package, script) == expected
    assert names_of(package, package / "training" / "late.py") == expected


def test_an_entry_of_a_registry_counts_where_it_is_named(package: Path) -> None:
    assert names_of(package, package / "models" / "svr.py") == ["core/rows.py", "models/svr.py"]
    both = names_of(package, package.parent / "script.py", package / "models" / "svr.py")
    assert "models/svr.py" in both
    assert "models/lasso.py" not in both
    assert names_of(package, package / "models" / "__init__.py") == [
        "core/rows.py",
        "models/__init__.py",
        "models/lasso.py",
        "models/svr.py",
    ]


def test_a_module_without_effect_counts_as_a_source_alone(package: Path) -> None:
    assert names_of(package, package / "core" / "errors.py") == ["core/errors.py"]
    assert "core/errors.py" not in names_of(package, package / "data" / "table.py")
