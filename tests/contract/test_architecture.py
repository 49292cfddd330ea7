"""The architecture, read off the source. Every rule holds for every file: there are no lists of exemptions."""

from __future__ import annotations

import ast
import re
import statistics
import subprocess
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
import yaml

from softkin.core.imported_code import imported_modules
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from tests.conftest import HOUSE

SOURCE = HOUSE / "src" / "softkin"
FILES = sorted(SOURCE.rglob("*.py"))
RULES = sorted((HOUSE / "workflow" / "rules").glob("*.smk"))
SCRIPTS = sorted((HOUSE / "workflow" / "scripts").glob("*.py"))
#: A package imports from those on lower levels, and from itself.
LEVELS = [
    {"core"},
    {"data", "models"},
    {"training"},
    {"uncertainty"},
    {"evaluation"},
    {"reporting"},
    {"campaigns"},
    {"tracking"},
    {"cli"},
]
LEVEL = {package: level for level, packages in enumerate(LEVELS) for package in packages}
#: Where a library may be imported; `optuna` elsewhere for type checkers alone.
PLACES = {
    "mlflow": "tracking/",
    "matplotlib": "reporting/figures/",
    "optuna": "training/study.py",
    "jinja2": "reporting/page/build.py",
    "snakemake": "nowhere",
}


def module_of(path: Path) -> str:
    """'softkin.data.table' of its file; a package's name of its `__init__`."""
    return ".".join(path.relative_to(SOURCE.parent).with_suffix("").parts).removesuffix(".__init__")


MODULES = {module_of(path): path for path in FILES}


@cache
def nodes(path: Path) -> list[ast.AST]:
    """All that a file says; it is read once for all tests."""
    return list(ast.walk(ast.parse(path.read_text())))


@cache
def imports(path: Path) -> frozenset[str]:
    """Modules that a file imports anywhere, for type checkers too; of softkin the modules that define the names."""
    return frozenset(_imports(nodes(path)))


def _imports(nodes: Iterable[ast.AST]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (name if name in MODULES else node.module for name in names)


@cache
def imports_at_run_time(path: Path) -> frozenset[str]:
    """Modules that a file imports, but for those inside `if TYPE_CHECKING:`."""
    module, *_ = nodes(path)
    assert isinstance(module, ast.Module)
    of_types = [node for node in module.body if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)]
    if not of_types:
        return imports(path)
    return frozenset(_imports(node for part in module.body if part not in of_types for node in ast.walk(part)))


def package_of(module: str) -> str | None:
    """'data' of 'softkin.data.table'; None of another library's module, and of softkin's face."""
    parts = module.split(".")
    return parts[1] if parts[0] == "softkin" and len(parts) > 1 else None


def test_the_top_level_holds_nine_packages_and_no_loose_module() -> None:
    assert {path.name for path in SOURCE.glob("*.py")} == {"__init__.py"}
    assert {path.parent.name for path in SOURCE.glob("*/__init__.py")} == set(LEVEL)
    assert len(LEVEL) <= 10
    assert imported_modules(SOURCE / "__init__.py") == (), "softkin's face imports when it is asked for a name"


@pytest.mark.parametrize("module", MODULES)
def test_imports_run_down(module: str) -> None:
    own = package_of(module)
    others = {package_of(imported) for imported in imports(MODULES[module])} - {None, own}
    assert own is None or all(LEVEL[other] < LEVEL[own] for other in others if other), others


def test_no_imports_run_in_a_circle() -> None:
    """For type checkers neither; `prepare` raises an error that names the circle."""
    TopologicalSorter({module: imports(path) & set(MODULES) for module, path in MODULES.items()}).prepare()


@pytest.mark.parametrize("library", PLACES)
def test_a_library_is_imported_in_one_place(library: str) -> None:
    for path in FILES:
        libraries = {name.split(".")[0] for name in imports_at_run_time(path)}
        place = path.relative_to(SOURCE).as_posix()
        assert library not in libraries or place.startswith(PLACES[library]), place


#: Scripts whose jobs fit nothing and score nothing.
LIGHT = [path for path in SCRIPTS if path.stem in ("prepare", "build_tables", "summarise", "build_report")]
LEARNING = {"scipy", "sklearn", "xgboost", "optuna", "mlflow", "matplotlib"}


@pytest.mark.parametrize(
    ("files", "among", "unwanted"),
    [(RULES, "softkin.cli.configuration", LEARNING | {"pandas"}), (LIGHT, "softkin.data.prepare", LEARNING)],
    ids=["rules", "scripts that fit nothing"],
)
def test_what_learns_nothing_imports_no_learning_library(files: list[Path], among: str, unwanted: set[str]) -> None:
    """Snakemake imports all that the rules import, registries among it, each time it starts; each job starts anew."""
    text = "".join(path.read_text() for path in files)
    modules = sorted(set(re.findall(r"^(?:from|import) (softkin[\w.]*)", text, re.MULTILINE)))
    assert {"softkin.models", "softkin.uncertainty.regions", among} <= set(modules)
    code = f"import sys, {', '.join(modules)}; "
    code += "print(*sorted({m.split('.')[0] for m in sys.modules}))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not unwanted & set(loaded)


def test_nobody_asks_which_model_or_dataset_it_is() -> None:
    names = [*MODELS, *yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]]
    asked = re.compile(rf"""(==|!=|\bin)\s*[(\[{{]?\s*["']({"|".join(names)})["']""")
    for path in [*FILES, *SCRIPTS, *RULES]:
        assert not asked.search(path.read_text()), path


def test_no_model_is_named_outside_models() -> None:
    names = {*MODELS, *QUANTILE_MODELS}
    for path in [*SCRIPTS, *(path for module, path in MODULES.items() if package_of(module) != "models")]:
        texts = {node.value for node in nodes(path) if isinstance(node, ast.Constant)}
        assert not texts & names, path
    for path in RULES:
        assert not set(re.findall(r"[\"'](\w+)[\"']", path.read_text())) & names, path


def blocks() -> dict[str, str]:
    """Name -> text of each rule."""
    # A rule that is made for each group of datasets has a name that is made, see workflow/rules/groups.smk.
    named = re.compile(r'^ *rule(?: (?=\w+:)|:\s+name:\s+name_of\(")(\w+)', re.MULTILINE)
    texts = [named.split(path.read_text())[1:] for path in RULES]
    return {name: block for text in texts for name, block in zip(text[::2], text[1::2], strict=True)}


def test_each_script_serves_the_rule_of_its_name() -> None:
    everything = "".join(path.read_text() for path in RULES)
    for name, block in blocks().items():
        assert re.findall(r'"\.\./scripts/(\w+)\.py"', block) == [name]
        # Fetching a file and making the store are done once: editing their code must not repeat them.
        assert "code=" in block or name in ("retrieve", "create_store"), name
        assert re.search(rf'code_of\(\s*"{name}"', everything) or name in ("retrieve", "create_store"), name
    assert {path.stem for path in SCRIPTS} == set(blocks())


def test_each_job_is_told_what_it_reads() -> None:
    """A result that is cut off or damaged is then named; a user's own files are checked by what reads them."""
    for path in SCRIPTS:
        arguments = re.findall(r"with job\((.*)\):", path.read_text())
        assert len(arguments) == 1, path
        assert "snakemake.input" in arguments[0] or path.stem in ("retrieve", "create_store"), path


def test_logs_and_benchmarks_bear_the_name_of_their_rule() -> None:
    for name, block in blocks().items():
        stems = re.findall(r"\"results/(logs|benchmarks)/(\w+)", block)
        assert "logs" in {kind for kind, _ in stems}, name
        assert {stem for _, stem in stems} == {name}


def test_tables_are_written_and_read_in_one_way() -> None:
    """What is infinite is a word in a CSV. Trials of a study are finite, and so is what others wrote."""
    writers = {path.stem for path in FILES if ".to_csv(" in path.read_text()}
    assert writers == {"csv_tables", "tune", "tune_quantiles"}
    readers = {path.stem for path in FILES if "pd.read_csv(" in path.read_text()}
    others = {"published", "published_intervals", "recordings", "figure_index", "images", "jobs"}
    assert readers == {"csv_tables", *others}


def test_rules_are_plain() -> None:
    for path in RULES:
        text = path.read_text()
        assert not re.search(r"^\s+run:", text, re.MULTILINE), f"{path.name}: no run: blocks"
        assert "lambda" not in text, f"{path.name}: no lambdas"


def test_files_stay_short() -> None:
    lengths = {path: len(path.read_text().splitlines()) for path in [*FILES, *RULES, *SCRIPTS]}
    assert max(lengths[path] for path in FILES) <= 250, max(FILES, key=lambda path: lengths[path])
    assert max(lengths[path] for path in RULES) <= 200
    assert statistics.median(lengths[path] for path in FILES) <= 100
    assert len((HOUSE / "Snakefile").read_text().splitlines()) <= 60
    assert not [path for path in lengths if path.stem in ("utils", "helpers", "common", "misc")]


def test_functions_stay_short_and_take_few_parameters() -> None:
    for path in [*FILES, *SCRIPTS, *(HOUSE / "tools").rglob("*.py")]:
        for node in nodes(path):
            if isinstance(node, ast.FunctionDef):
                arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                parameters = [parameter for parameter in arguments if parameter.arg not in ("self", "cls")]
                assert len(parameters) <= 8, f"{path}: {node.name}"
                assert node.end_lineno is not None
                assert node.end_lineno - node.lineno < 60, f"{path}: {node.name}"


def test_protocols_name_their_types() -> None:
    for path in SOURCE.rglob("spec.py"):
        assert "Callable[[Any" not in path.read_text(), path


@pytest.mark.parametrize("path", [path for path in FILES if path.name != "__init__.py"], ids=module_of)
def test_every_module_has_its_test_file(path: Path) -> None:
    place = path.relative_to(SOURCE)
    assert (HOUSE / "tests" / "unit" / place.parent / f"test_{place.name}").is_file()
