"""The rules of the house, read off the source."""

from __future__ import annotations

import ast
import re
import statistics
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from softkin.core.runs import PRESETS
from softkin.models import MODELS
from tests.conftest import HOUSE

SOURCE = HOUSE / "src" / "softkin"
MODULES = sorted(path.relative_to(SOURCE) for path in SOURCE.rglob("*.py"))
#: Lower floors first; a module imports from floors below it, and within its own folder only where listed here.
FLOORS = [
    {"interface", "__init__", "durations"},
    {"files", "job", "conformal", "bounds", "folds", "findings", "growth", "rows", "shells", "standins"},
    {
        "watching",
        "configuration",
        "datasets",
        "estimators",
        "models",
        "quantile_models",
        "intervals",
        "regions",
        "metrics",
        "smooth_fit",
    },
    {"target_spaces"},
    {"fitting", "outside", "quantiles", "tables", "new_robot", "auditing"},
    {"scoring", "tuning", "refitting", "evidence"},
    {
        "calibrating",
        "choosing_intervals",
        "refitting_shells",
        "refitting_spaces",
        "tuning_models",
        "tuning_quantiles",
        "scoring_regions",
    },
    {
        "scoring_intervals",
        "scoring_outside",
        "conditional_coverage",
        "figures",
        "calibrated_model",
        "report",
        "gallery",
    },
    {"tracking"},
]
#: A folder's __init__ is its registry, preparing is the one call of its stage, table_file reads either kind of file,
#: build gathers the tables.
GATHERERS = {"datasets/__init__.py", "datasets/preparing.py", "models/__init__.py", "tables/build.py"}
GATHERERS |= {"datasets/table_file.py"}
GATHERERS |= {
    "intervals/__init__.py",
    "intervals/inside_and_outside.py",
    "quantile_models/__init__.py",
    "tables/interval_layout.py",
    "tables/published_intervals.py",
}
GATHERERS |= {f"outside/{path.name}" for path in (SOURCE / "outside").glob("*.py")} - {"outside/method.py"}
GATHERERS |= {"regions/__init__.py", "regions/ellipsoids.py"}
GATHERERS |= {"auditing/__init__.py", "auditing/data_card.py", "auditing/cleaning.py"}
GATHERERS |= {f"target_spaces/{name}.py" for name in ("__init__", "curvature", "base_frame")}
#: Simulated robots stand on one rod.
GATHERERS |= {f"standins/{path.name}" for path in (SOURCE / "standins").glob("*.py")} - {
    "standins/rod.py",
    "standins/robot.py",
}
GATHERERS |= {"tables/headline.py", "tracking/__init__.py", "tracking/models.py", "tracking/intervals.py"}
GATHERERS |= {"tracking/champion.py"}

#: The view draws the lines, which tell the progress.
GATHERERS |= {"watching/lines.py", "watching/view.py"}

#: The page is gathered from its parts.
GATHERERS |= {
    f"report/{name}.py"
    for name in ("building", "cards", "grid", "headline", "jobs", "outside", "provenance", "published", "scores")
}

FIGURES = {module.as_posix() for module in MODULES if module.parts[0] == "figures"}
#: All figures have one style, and read their data alike.
GATHERERS |= FIGURES


def imports(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
    return found


def part(module: str) -> str:
    """'datasets' of 'softkin.data.table'."""
    return module.split(".")[1] if "." in module else "__init__"


def floor(name: str) -> int:
    return next(level for level, names in enumerate(FLOORS) if name in names)


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_imports_go_down_only(module: Path) -> None:
    mine = module.parts[0].removesuffix(".py")
    for imported in (name for name in imports(SOURCE / module) if name.split(".")[0] == "softkin"):
        theirs = part(imported)
        lazy_estimator = mine in ("models", "quantile_models", "intervals") and theirs == "estimators"
        gathering = theirs == mine and module.as_posix() in GATHERERS
        assert floor(theirs) < floor(mine) or gathering or lazy_estimator, f"{module} imports {imported}"


@pytest.mark.parametrize(
    ("library", "allowed"),
    [
        ("mlflow", {f"tracking/{name}.py" for name in ("store", "models", "champion", "served_model")}),
        ("matplotlib", FIGURES),
        ("snakemake", set()),
        ("optuna", {"tuning.py"}),
        ("jinja2", {"report/building.py"}),
    ],
)
def test_a_library_is_imported_in_its_one_place(library: str, allowed: set[str]) -> None:
    learners = [path for folder in ("models", "quantile_models") for path in (SOURCE / folder).glob("*.py")]
    typing_only = {"interface.py", "tuning_models.py"} | {path.relative_to(SOURCE).as_posix() for path in learners}
    for module in MODULES:
        if module.as_posix() in typing_only and library in ("optuna", "matplotlib"):
            continue
        names = {name.split(".")[0] for name in imports(SOURCE / module)}
        assert library not in names or module.as_posix() in allowed, module


def test_registries_import_no_learning_library() -> None:
    """Snakemake imports them each time it starts: all that the rules import, read off the rules."""
    rules = "".join(path.read_text() for path in (HOUSE / "workflow" / "rules").glob("*.smk"))
    modules = sorted(set(re.findall(r"^(?:from|import) (softkin[\w.]*)", rules, re.MULTILINE)))
    assert {"softkin.models", "softkin.uncertainty.regions", "softkin.data.standins"} <= set(modules)
    code = f"import sys, {', '.join(modules)}; "
    code += "print(*sorted({m.split('.')[0] for m in sys.modules}))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"scipy", "sklearn", "xgboost", "optuna", "mlflow", "matplotlib", "pandas"} & set(loaded)


def test_nobody_asks_which_model_or_dataset_it_is() -> None:
    names = [*MODELS, *yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]]
    asked = re.compile(rf"""(==|!=|\bin)\s*[(\[{{]?\s*["']({"|".join(names)})["']""")
    for path in [*SOURCE.rglob("*.py"), *(HOUSE / "workflow").rglob("*.py"), *(HOUSE / "workflow").rglob("*.smk")]:
        assert not asked.search(path.read_text()), path


def test_each_script_serves_the_rule_of_its_name() -> None:
    rules: dict[str, str] = {}
    for path in (HOUSE / "workflow" / "rules").glob("*.smk"):
        text = path.read_text()
        assert not re.search(r"^\s+run:", text, re.MULTILINE), f"{path.name}: no run: blocks"
        assert "lambda" not in text, f"{path.name}: no lambdas"
        blocks = re.split(r"^rule (\w+):", text, flags=re.MULTILINE)[1:]
        for name, block in zip(blocks[::2], blocks[1::2], strict=True):
            script = re.search(r'"\.\./scripts/(\w+)\.py"', block)
            assert script, name
            assert "log:" in block, f"rule {name} has no log"
            # Fetching a file and making the store are done once: editing their code must not repeat them.
            assert "package(" in block or name in ("retrieve", "create_store"), f"rule {name} lists no module"
            rules[name] = script[1]
    assert all(name == script for name, script in rules.items())
    assert {path.stem for path in (HOUSE / "workflow" / "scripts").glob("*.py")} == set(rules)


def test_files_stay_short() -> None:
    paths = [*SOURCE.rglob("*.py"), *(HOUSE / "workflow").rglob("*.smk"), *(HOUSE / "workflow").rglob("*.py")]
    lengths = {path: len(path.read_text().splitlines()) for path in paths}
    assert max(lengths.values()) <= 300, max(lengths, key=lambda path: lengths[path])
    assert statistics.median(lengths.values()) <= 100
    assert len((HOUSE / "Snakefile").read_text().splitlines()) < 60
    assert not [path for path in paths if path.stem in ("utils", "helpers", "common_utils")]


def test_the_presets_of_the_schema_are_those_of_the_code() -> None:
    schema = yaml.safe_load((HOUSE / "workflow" / "schemas" / "config.schema.yaml").read_text())
    assert tuple(schema["properties"]["presets"]["items"]["enum"]) == PRESETS


def test_every_key_of_the_configuration_is_explained() -> None:
    schema = yaml.safe_load((HOUSE / "workflow" / "schemas" / "config.schema.yaml").read_text())
    text = (HOUSE / "config" / "README.md").read_text()
    entry = schema["properties"]["sources"]["additionalProperties"]["properties"]
    nested = [schema["properties"][key]["properties"] for key in ("tuning", "refitting", "shells")]
    for key in [*schema["properties"], *(key for keys in nested for key in keys), *entry]:
        assert f"`{key}`" in text, f"config/README.md does not explain `{key}`"
