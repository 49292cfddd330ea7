"""Entries of config/datasets.yaml that cannot be used."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tests.contract.bad_inputs.case import BadInput, check_with, configured

OWN: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "arm.csv", "position_unit": "mm"}
OWN |= {"commands": ["u1", "u2"], "positions": ["x", "y", "z"], "split": {"method": "random"}}


def own(changes: Mapping[str, Any], name: str = "arm", without: str = "") -> Callable[[], None]:
    """The entry of a robot of one's own with changes; its file is there."""

    def provoke() -> None:
        Path("arm.csv").write_text("u1,u2,x,y,z\n")
        entry = {key: value for key, value in {**OWN, **changes}.items() if key != without}
        check_with({"datasets": [name], "sources": {name: entry}})

    return provoke


def several(files: list[Any], **changes: Any) -> Callable[[], None]:
    """The entry of a robot in several files, of which arm.csv is there."""
    return own({"files": files, **changes}, without="file")


def published(changes: Mapping[str, Any]) -> Callable[[], None]:
    return lambda: check_with({"sources": {"finger": changes}})


def named(name: Any) -> Callable[[], None]:
    return own({}, name)


NAMES = {"train": 0, "validation": 1, "test": 1, "extrapolation": 3}
CASES = [
    BadInput("no datasets", configured("datasets: []"), ("datasets: []",)),
    BadInput("a dataset without an entry", configured("datasets: [fingers]"), ("did you mean 'finger'?",)),
    BadInput("a dataset twice", configured("datasets: [finger, finger]"), ("datasets", "non-unique")),
    BadInput("a dataset that YAML reads as no", configured("datasets: [no]"), ("datasets.0: False is no text",)),
    *(
        BadInput(f"a dataset named {name}", named(name), (f"results/{name}", "softkin's own"))
        for name in ("tables", "logs", "benchmarks", "studies", "manifest", "schedules", "demo")
    ),
    *(
        BadInput(f"a dataset named {name}", named(name), (f"sources.{name}", "experiment of softkin's own"))
        for name in ("campaigns", "champions", "history")
    ),
    BadInput("a dataset named with a slash", named("my/arm"), ("sources", "'my/arm'", "a letter a-z")),
    BadInput("a dataset named ..", named(".."), ("sources", "a letter a-z")),
    BadInput("a dataset named with a blank", named("my arm"), ("sources", "a letter a-z")),
    BadInput("a dataset named in capitals", named("Finger"), ("sources", "a letter a-z")),
    BadInput("a dataset named with an umlaut", named("grün"), ("sources", "a letter a-z")),
    BadInput("a dataset named by nothing", named(""), ("sources", "a letter a-z")),
    BadInput("a dataset named with a line break", named("arm\n"), ("sources", "a letter a-z")),
    BadInput("a dataset named in 300 letters", named("a" * 300), ("sources", "at most 60")),
    BadInput("a dataset named like a stand-in", named("finger_standin"), ("the stand-in of finger",)),
    BadInput("an entry that is no set of keys", configured("sources: {arm: 3}"), ("sources.arm: 3 is no set",)),
    BadInput("an unknown key", own({"dimension": 2}), ("sources.arm", "did you mean 'dimensions'?")),
    BadInput("no title", own({}, without="title"), ("sources.arm: 'title' is a required",)),
    BadInput("an empty title", own({"title": " "}), ("sources.arm.title",)),
    BadInput("a title of two lines", own({"title": "A\nB"}), ("sources.arm.title", "several lines")),
    BadInput(
        "one title twice",
        lambda: check_with({"sources": {"finger": {"title": "Arm"}, "abaqus": {"title": "Arm"}}}),
        ("abaqus, finger", "one title"),
    ),
    BadInput("an unknown format", own({"format": "csv"}), ("sources.arm.format: 'csv' is no format",)),
    BadInput("the format of stand-ins", own({"format": "simulated"}), ("sources.arm.format", "stand-ins")),
    BadInput("a file that is not there", own({"file": "am.csv"}), ("there is no file am.csv",)),
    BadInput("a file that is a folder", own({"file": "."}), ("sources.arm.file: . is a folder",)),
    BadInput("a file with a zero byte", own({"file": "a\0.csv"}), ("sources.arm.file", "control character")),
    BadInput("file and files", own({"files": ["arm.csv"]}), ("sources.arm", "'file'", "does not go with files")),
    BadInput("neither file nor files", own({}, without="file"), ("sources.arm: 'file' is a required",)),
    BadInput("a join of one file", own({"join": {"by": "row"}}), ("sources.arm", "'join'", "goes with files")),
    BadInput("a join of one item", several(["arm.csv"], join={"by": "row"}), ("sources.arm.join", "cannot be joined")),
    BadInput("no files", several([]), ("sources.arm.files: []",)),
    BadInput("files of which one is not there", several(["arm.csv", "tip.csv"]), ("files.1", "no file tip.csv")),
    BadInput("a pattern that no file matches", several(["trial_*.csv"]), ("files.0", "is named like 'trial_*.csv'")),
    BadInput("an unknown key of a file", several([{"file": "arm.csv", "sep": ";"}]), ("unknown key 'sep'",)),
    BadInput("an unknown join", several(["arm.csv"], join={"by": "times"}), ("did you mean 'time'?",)),
    BadInput(
        "a join by time without tolerance", several(["arm.csv"], join={"by": "time", "column": "t"}), ("tolerance",)
    ),
    BadInput("a join by no column", several(["arm.csv"], join={"by": "column"}), ("'column' is a required",)),
    BadInput(
        "three columns for two files",
        several(["arm.csv", "arm.csv"], join={"by": "column", "column": ["a", "b", "c"]}),
        ("sources.arm.join.column: 3 columns for 2 files",),
    ),
    BadInput("a join by row with a column", several(["arm.csv"], join={"by": "row", "column": "t"}), ("'column'",)),
    BadInput("an unknown unit", own({"position_unit": "inch"}), ("sources.arm.position_unit", "in")),
    BadInput("no commands", own({"commands": []}), ("sources.arm.commands",)),
    BadInput("a pattern that is none", own({"commands": "u[0-9"}), ("sources.arm.commands", "is no pattern")),
    BadInput("a column twice", own({"positions": ["x", "x", "z"]}), ("sources.arm.positions",)),
    BadInput("a column as command and position", own({"commands": ["x"]}), ("'x' stands in `commands` and",)),
    BadInput("two coordinates of three", own({"positions": ["x", "y"]}), ("2 columns, but 3 per marker",)),
    BadInput("257 commands", own({"commands": [f"u{i}" for i in range(257)]}), ("257 columns, of at most 256",)),
    BadInput("another number of commands", own({"n_commands": 3}), ("sources.arm.n_commands: 3", "names 2")),
    BadInput("another number of markers", own({"n_markers": 2}), ("sources.arm.n_markers: 2", "names 1")),
    BadInput(
        "an orientation of an unknown kind",
        own({"orientation": {"kind": "quaternion", "columns": ["a", "b", "c", "d"]}}),
        ("sources.arm.orientation.kind", "quaternion_xyzw"),
    ),
    BadInput(
        "a quaternion of three columns",
        own({"orientation": {"kind": "quaternion_xyzw", "columns": ["a", "b", "c"]}}),
        ("sources.arm.orientation.columns",),
    ),
    BadInput(
        "a coordinate as an angle",
        own({"orientation": {"kind": "roll_pitch_yaw_radians", "columns": ["x", "b", "c"]}}),
        ("'x' stands in `positions` and in `orientation`",),
    ),
    BadInput("four dimensions", own({"dimensions": 4}), ("sources.arm.dimensions: 4 is none of 2, 3",)),
    BadInput("a letter as delimiter", own({"delimiter": "a"}), ("sources.arm.delimiter",)),
    BadInput("an unknown split", own({"split": {"method": "groups"}}), ("did you mean 'group'?",)),
    BadInput("a split without its column", own({"split": {"method": "group"}}), ("'column' is a required",)),
    BadInput(
        "a share of 95 %",
        own({"split": {"method": "random", "extrapolation_share": 0.95}}),
        ("extrapolation_share: 0.95",),
    ),
    BadInput("three blocks of time", own({"split": {"method": "time", "column": "t", "blocks": 3}}), ("blocks: 3",)),
    BadInput(
        "two subsets of one name",
        own({"split": {"method": "column", "column": "part", "names": NAMES}}),
        ("'1' names 2 subsets",),
    ),
    BadInput("an axis without direction", own({"base": {"axis": [0, 0, 1e-200]}}), ("base.axis", "no direction")),
    BadInput("an axis of zeros", own({"base": {"axis": [0, 0, 0]}}), ("base.axis",)),
    BadInput("an axis that is infinite", own({"base": {"axis": [0, 0, float("inf")]}}), ("base.axis.2: inf",)),
    BadInput("a base that is far away", own({"base": {"origin": [0, 0, 1e9]}}), ("base.origin.2", "write mm")),
    BadInput("no rows of train", own({"rows": dict.fromkeys(NAMES, 5) | {"train": 0}}), ("rows.train: 0",)),
    BadInput(
        "urls without a hash",
        own({"urls": ["https://x.org/a"], "licence": "CC0", "citation": "nobody"}),
        ("'sha256' is a dependency of 'urls'",),
    ),
    BadInput("a hash that is none", published({"sha256": "abc"}), ("sources.finger.sha256",)),
    BadInput("no urls", published({"urls": []}), ("sources.finger.urls",)),
    BadInput("a URL of FTP", published({"urls": ["ftp://x.org/a"]}), ("sources.finger.urls.0", "no http")),
    BadInput("a URL without a server", published({"urls": ["https:///a"]}), ("names no server",)),
    BadInput("a file outside the mirror", published({"file": "../../etc/passwd"}), ("leads out of the mirror",)),
    BadInput("an absolute file in a mirror", published({"file": "/etc/passwd"}), ("leads out of the mirror",)),
    BadInput("a key of another format", published({"split": {"method": "random"}}), ("belongs to format table_file",)),
    BadInput("257 commands of a published robot", published({"n_commands": 257}), ("sources.finger.n_commands: 257",)),
    BadInput("an unknown stand-in", published({"standin": {"robot": "fnger", "seed": 0}}), ("no simulated robot",)),
    BadInput("settings of an unknown model", published({"paper_params": {"mpl": {}}}), ("did you mean 'mlp'?",)),
    BadInput(
        "an unknown setting", published({"paper_params": {"mlp": {"max_itr": 14}}}), ("'max_itr' is no parameter",)
    ),
    BadInput(
        "a setting in quotes",
        published({"paper_params": {"mlp": {"max_iter": "14"}}}),
        ("'max_iter' must be a number",),
    ),
    BadInput("a setting below 1", published({"paper_params": {"mlp": {"max_iter": 0}}}), ("'max_iter' must be",)),
    BadInput(
        "a setting that is no choice", published({"paper_params": {"mlp": {"activation": "tan"}}}), ("tanh or relu",)
    ),
]
