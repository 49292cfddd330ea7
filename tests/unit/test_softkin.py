from __future__ import annotations

import doctest
import subprocess
import sys

import pytest

import softkin
from softkin.core.errors import SoftkinError
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.loading import load


def test_public_names_are_those_of_their_modules() -> None:
    assert softkin.CalibratedModel is CalibratedModel
    assert softkin.SoftkinError is SoftkinError
    assert softkin.load is load
    assert set(softkin.__all__) == {"CalibratedModel", "SoftkinError", "__version__", "load"}
    with pytest.raises(AttributeError, match="module 'softkin' has no attribute 'Nonsense'"):
        _ = softkin.Nonsense  # type: ignore[attr-defined]


def loaded_after(statement: str) -> set[str]:
    """Top-level modules that a fresh interpreter has loaded after a statement."""
    code = f"{statement}\nimport sys\nprint(*sorted({{name.partition('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_the_package_loads_no_numerical_library_before_it_is_used() -> None:
    heavy = {"numpy", "pandas", "sklearn", "scipy", "mlflow", "matplotlib", "xgboost"}
    assert not loaded_after("import softkin") & heavy
    assert not loaded_after("from softkin import SoftkinError") & heavy
    assert {"numpy", "pandas", "sklearn"} <= loaded_after("from softkin import CalibratedModel")


@pytest.mark.parametrize("name", ["CalibratedModel", "SoftkinError"])
def test_the_example_in_a_docstring_runs_and_prints_what_it_says(name: str) -> None:
    (example,) = doctest.DocTestFinder(recurse=False).find(getattr(softkin, name), name, globs={})
    results = doctest.DocTestRunner().run(example)
    assert results.attempted > 1
    assert results.failed == 0
