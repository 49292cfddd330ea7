"""Files that are no configuration, or say two things."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from softkin.core.config_files import check_config_files
from tests.contract.bad_inputs.case import BadInput, configured

TWICE = "stands twice"


def at(path: str, make: Callable[[Path], object] = lambda _: None) -> Callable[[], None]:
    def provoke() -> None:
        make(Path(path))
        check_config_files([path])

    return provoke


CASES = [
    BadInput("a key twice", configured("seed: 1\nmodels: [lr]\nseed: 2\n"), ("more.yaml, line 3", "'seed'", TWICE)),
    BadInput("a key twice in a section", configured("tuning:\n  n_trials: 4\n  n_trials: 5\n"), ("line 3", TWICE)),
    BadInput("a key twice in braces", configured("tuning: {n_trials: 4, n_trials: 5}\n"), ("'n_trials'", TWICE)),
    BadInput("one dataset twice", configured("sources:\n  arm: {title: A}\n  arm: {title: B}\n"), ("'arm'", TWICE)),
    BadInput("the same key, once in quotes", configured("seed: 1\n'seed': 2\n"), ("'seed'", TWICE)),
    BadInput("JSON with a key twice", configured('{"seed": 1, "seed": 2}'), ("'seed'", TWICE)),
    BadInput("JSON with NaN", configured('{"confidence_levels": [NaN]}'), ("NaN", "no JSON number")),
    BadInput("JSON with a number beyond floats", configured('{"seed": 1e400}'), ("too large a number: 1e400",)),
    BadInput("JSON with a number of 5,000 digits", configured('{"seed": ' + "9" * 5000 + "}"), ("5000 digits",)),
    BadInput("JSON nested 100,000 deep", configured('{"a": ' + "[" * 100_000 + "]" * 100_000 + "}"), ("too deeply",)),
    BadInput("YAML nested 100,000 deep", configured("a: " + "[" * 100_000 + "]" * 100_000), ("too deeply",)),
    BadInput("a number of 5,000 digits", configured("seed: " + "9" * 5000), ("5000 digits", "line 1")),
    BadInput("an octal number", configured("seed: 010\n"), ("010", "another number", "line 1")),
    BadInput("a sexagesimal number", configured("tuning: {n_trials: 1:30}\n"), ("1:30", "another number")),
    BadInput("a tab as indentation", configured("tuning:\n\tn_trials: 4\n"), ("line 2", "blanks, not by tabs")),
    BadInput("a bracket left open", configured("models: [lr, gb\nseed: 1\n"), ("line 2", "brackets in pairs")),
    BadInput("no blank after a colon", configured("seed:1\nmodels: [lr]\n"), ("line 2", "blank after a colon")),
    BadInput("a colon in text without quotes", configured("caution: careful: few rows\n"), ("line 1", "quotes")),
    BadInput("an alias without its anchor", configured("models: *pool\n"), ("line 1", "pool")),
    BadInput("a Python object", configured("seed: !!python/object/apply:os.getpid []\n"), ("tag", "line 1")),
    BadInput("two documents in one file", configured("seed: 1\n---\nseed: 2\n"), ("line 2", "document")),
    BadInput("a list at the top level", configured("- seed\n- models\n"), ("no keys at its top level",)),
    BadInput("an empty file", configured(""), ("no keys at its top level",)),
    BadInput("comments alone", configured("# seed: 1\n"), ("no keys at its top level",)),
    BadInput("text alone", configured("seed\n"), ("no keys at its top level",)),
    BadInput("a file in Latin-1", configured("caution: für\n".encode("latin-1")), ("UTF-8", "more.yaml")),
    BadInput("a binary file", configured(bytes(range(128))), ("not readable as YAML",)),
    BadInput("a file that is not there", at("absent.yaml"), ("absent.yaml", "no such file")),
    BadInput("a folder in its place", at("folder.yaml", lambda path: path.mkdir(exist_ok=True)), ("is a directory",)),
]
