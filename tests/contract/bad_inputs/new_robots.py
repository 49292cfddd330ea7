"""Files that `make new-robot` cannot guess an entry from."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from softkin.cli.new_robot import show_and_write
from tests.contract.bad_inputs.case import BadInput
from tests.contract.bad_inputs.tables import GOOD

#: A marker in two frames.
FRAMES = "u1,a_x,a_y,b_x,b_y\n" + "".join(f"{n},{n * n},{n % 5},{n * n + 100},{n % 5 + 50}\n" for n in range(20))


def of(text: str, *, file: str = "arm.csv", name: str | None = None, write: bool = False) -> Callable[[], None]:
    def provoke() -> None:
        Path("arm.csv").write_text(text)
        Path("config").mkdir(exist_ok=True)
        Path("config/config.yaml").write_text("datasets: [finger]\n")
        Path("config/datasets.yaml").write_text("sources:\n  finger: {title: Finger}\n")
        show_and_write([file], name, write)

    return provoke


def without(path: str, text: str) -> Callable[[], None]:
    """The file of a good robot is to be appended to a configuration that holds this text."""

    def provoke() -> None:
        Path("config").mkdir(exist_ok=True)
        for name in ("config/config.yaml", "config/datasets.yaml"):
            Path(name).write_text("datasets: [finger]\nsources:\n  finger: {title: Finger}\n")
        Path(path).write_text(text)
        Path("arm.csv").write_text(GOOD)
        show_and_write(["arm.csv"], None, True)

    return provoke


CASES = [
    BadInput("a file that is not there", of(GOOD, file="am.csv"), ("no such file: 'am.csv'",)),
    BadInput("a folder", of(GOOD, file="config"), ("no such file: 'config'",)),
    BadInput("no file", of(GOOD, file=""), ("no such file: ''",)),
    BadInput("a name with a slash", of(GOOD, name="../arm"), ("'../arm' is no name",)),
    BadInput("a name in capitals", of(GOOD, name="Arm"), ("'Arm' is no name",)),
    BadInput("a name of softkin's own", of(GOOD, name="tables"), ("results/tables", "another name")),
    BadInput("a name that is taken", of(GOOD, name="finger", write=True), ("there is an entry 'finger' already",)),
    BadInput("a question that nobody answered", of(FRAMES, write=True), ("a question is open", "--answer")),
    BadInput("an empty file", of(""), ("arm.csv", "the file is empty")),
    BadInput("a header alone", of("u1,x,y,z\n"), ("arm.csv", "no row of numbers")),
    BadInput("no header", of("1,2,3,4\n5,6,7,8\n"), ("arm.csv", "no header")),
    BadInput("no positions", of("u1,u2\n1,2\n"), ("arm.csv", "no columns look like positions")),
    BadInput("no commands", of("x,y,z\n1,2,3\n"), ("arm.csv", "no column looks like a command")),
    BadInput("two units", of("u1,x_mm,y_mm,z_m\n1,2,3,4\n"), ("arm.csv", "different units")),
    BadInput("a word for a number", of("u1,x,y,z\n1,2,3,a\n"), ("arm.csv, line 2, column 'z'", "no number: 'a'")),
    BadInput(
        "a config.yaml without datasets", without("config/config.yaml", "seed: 1\n"), ("config.yaml", "`datasets`")
    ),
    BadInput("datasets that are no list", without("config/config.yaml", "datasets: a\n"), ("`datasets` is no list",)),
    BadInput("a datasets.yaml that is no YAML", without("config/datasets.yaml", "sources: {"), ("datasets.yaml",)),
    BadInput("sources that are not last", without("config/datasets.yaml", "sources: {}\n"), ("by hand",)),
]
