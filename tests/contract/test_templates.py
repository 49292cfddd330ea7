"""Each template, copied and registered as its first lines say, keeps the contract of its registry."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tests.conftest import HOUSE

#: Template -> package that it is copied to, registry, suite.
TEMPLATES = {
    "model": ("models", "MODELS", "test_models.py"),
    "interval_method": ("uncertainty/intervals", "INTERVAL_METHODS", "test_interval_methods.py"),
    "check": ("data/audit", "CHECKS", "test_checks.py"),
    "figure": ("reporting/figures", "FIGURES", "test_figures.py"),
}


def register(source: Path, template: str) -> str:
    """Copy the template into the package tree `source` and register it there; the name of the entry."""
    package, registry, _ = TEMPLATES[template]
    text = (HOUSE / "templates" / f"{template}.py").read_text()
    entry = re.search(r'^#\s+"(\w+)": (\w+)\.(\w+),$', text, re.MULTILINE)
    assert entry
    name, module, _ = entry.groups()
    assert f"src/softkin/{package}/<name>.py" in text
    (source / package / f"{module}.py").write_text(text)
    init = source / package / "__init__.py"
    dotted = "softkin." + package.replace("/", ".")
    lines = f"from {dotted} import {module}\n\n\\g<0>\n    {entry[0].lstrip('# ')}"
    registered, n = re.subn(rf"^{registry}: .* = \{{$", lines, init.read_text(), flags=re.MULTILINE)
    assert n == 1
    init.write_text(registered)
    return name


def test_copied_templates_keep_their_contracts(tmp_path: Path) -> None:
    source = tmp_path / "softkin"
    shutil.copytree(HOUSE / "src" / "softkin", source)  # and its bytecode
    names = [register(source, template) for template in TEMPLATES]
    suites = [str(HOUSE / "tests" / "contract" / suite) for _, _, suite in TEMPLATES.values()]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-vv", *suites, "-k", " or ".join(names)],
        env=os.environ | {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"},
        cwd=HOUSE,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    for name, suite in zip(names, suites, strict=True):
        assert re.search(rf"{Path(suite).name}::\S*{name}\S* PASSED", done.stdout), f"{suite} has no test of {name}"


def test_every_template_is_tested() -> None:
    assert {path.stem for path in (HOUSE / "templates").glob("*.py")} == set(TEMPLATES)
