"""Which modules of softkin a file loads: its import statements are run, those inside functions too.

    python tests/workflow/loading.py LEFT_OUT SOURCE...

Prints as JSON, for each source, the modules that a fresh process has loaded. A package counts where a name is imported
from it, not where it is passed on the way to one of its modules. Those of LEFT_OUT, parted by commas, are never run.
"""

from __future__ import annotations

import ast
import builtins
import gc
import json
import multiprocessing
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

SOURCE = Path(__file__).parents[2] / "src"
LEFT_OUT = sys.argv[1].split(",")


def file_of(module: str) -> Path:
    place = SOURCE.joinpath(*module.split("."))
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")


class Package(ModuleType):
    """A package whose `__init__` is not run at first; of one that is left out every name is an empty registry."""

    def __init__(self, file: Path) -> None:
        super().__init__(".".join(file.parent.relative_to(SOURCE).parts))
        self.__path__ = [str(file.parent)]
        self.is_run = False

    def __getattr__(self, name: str) -> dict[str, Any]:
        is_of_python = name.startswith("__") and name != "__version__"
        if self.__name__ not in LEFT_OUT or is_of_python or file_of(f"{self.__name__}.{name}").is_file():
            raise AttributeError(name)
        return {}

    def run_for(self, names: tuple[str, ...]) -> None:
        """Run `__init__` if it is asked for a name that is no module."""
        asked = not names or not all(file_of(f"{self.__name__}.{name}").is_file() for name in names)
        if asked and not self.is_run and self.__name__ not in LEFT_OUT:
            self.is_run = True
            file = file_of(self.__name__)
            exec(compile(file.read_text(), file, "exec"), vars(self))


#: Import statements of softkin's own, by file: all are read once, before the first of many processes is forked.
STATEMENTS: dict[Path, list[tuple[str | None, CodeType]]] = {}


def imports(tree: ast.AST, of_softkin: bool) -> Iterator[ast.Import | ast.ImportFrom]:
    """The import statements of a file, but for those that only a type checker reads."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ImportFrom | ast.Import):
            name = node.module or "" if isinstance(node, ast.ImportFrom) else node.names[0].name
            if (name.split(".")[0] == "softkin") == of_softkin:
                yield node
        elif not (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)):
            yield from imports(node, of_softkin)


def loaded(source: str) -> list[str]:
    """The modules that one source loads, in this process."""
    packages = {package.__name__: package for package in map(Package, sorted(SOURCE.rglob("__init__.py")))}
    sys.modules.update(packages)
    plain_import = builtins.__import__

    def watched_import(name: str, *rest: Any) -> Any:
        if name in packages:
            packages[name].run_for(tuple(rest[2] or ()) if len(rest) > 2 else ())
        return plain_import(name, *rest)

    builtins.__import__ = watched_import  # type: ignore[assignment]  # the same signature, its defaults aside

    def names_loaded() -> list[str]:
        names = [name for name in sys.modules if name.split(".")[0] == "softkin"]
        return sorted(name for name in names if name not in packages or packages[name].is_run)

    never_loaded = set(LEFT_OUT) - set(packages)
    read: set[Path] = set()
    while waiting := {Path(source), *map(file_of, names_loaded())} - read:
        for file in waiting:
            for module, statement in STATEMENTS[file]:
                if module not in never_loaded:
                    exec(statement, {})
        read |= waiting
    return names_loaded()


def read_statements(file: Path, module: ast.Module) -> None:
    """Compile the import statements of softkin's own in a file."""
    STATEMENTS[file] = [
        (getattr(statement, "module", None), compile(ast.unparse(statement), file, "exec"))
        for statement in imports(module, of_softkin=True)
    ]


def main(sources: list[str]) -> None:
    for script in map(Path, sources):
        read_statements(script, ast.parse(script.read_text()))
    others: dict[str, None] = {}
    for file in sorted(SOURCE.rglob("*.py")):
        module = ast.parse(file.read_text())
        read_statements(file, module)
        module.body = [node for node in module.body if isinstance(node, ast.ImportFrom | ast.Import)]
        others |= dict.fromkeys(map(ast.unparse, imports(module, of_softkin=False)))
    for statement in others:  # other libraries, once for all processes
        if not statement.startswith("from __future__"):
            exec(statement, {})
    gc.freeze()
    gc.disable()
    with multiprocessing.get_context("fork").Pool(2, maxtasksperchild=1) as pool:
        print(json.dumps(dict(zip(sources, pool.map(loaded, sources, chunksize=1), strict=True))))


if __name__ == "__main__":
    main(sys.argv[2:])
