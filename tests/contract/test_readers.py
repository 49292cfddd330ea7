"""What every reader of a source format must do."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import SoftkinError
from softkin.core.files import sha256_of
from softkin.core.samples import SUBSETS, Samples, command_columns, coordinate_columns
from softkin.data.readers import READERS
from tests.conftest import four_subsets, published_json
from tests.contract import laws

Reader = Callable[..., dict[str, Samples]]
SIZES = dict.fromkeys(SUBSETS, 25)


@dataclass(frozen=True)
class Example:
    """A file that a reader reads: its text, its entry in config/datasets.yaml, what it holds (None: whatever it says),
    and what is no such file, for one reason or another.
    """

    text: str
    entry: Mapping[str, Any]
    holds: Mapping[str, Samples] | None
    bad: tuple[tuple[str, Mapping[str, Any]], ...]


def of_published_json() -> Example:
    arm = four_subsets(SIZES, n_commands=2, n_markers=2)
    entry = {"file": "arm.json", "n_commands": 2, "n_markers": 2}
    content = published_json(arm)
    without_a_subset = {key: rows for key, rows in content.items() if key != "val"}
    without_a_row = content | {"test": content["test"] | {"position": content["test"]["position"][1:]}}
    text, damaged = json.dumps(content), ["{", "[]", json.dumps(without_a_subset), json.dumps(without_a_row)]
    bad = [(other, entry) for other in damaged]
    return Example(text, entry, arm, (*bad, (text, entry | {"n_markers": 3})))


def of_a_table() -> Example:
    arm = four_subsets(SIZES, n_commands=2, n_markers=2)
    commands, positions = command_columns(2), coordinate_columns(2)
    frames = [
        pd.DataFrame(np.hstack([rows.commands, rows.positions]), columns=[*commands, *positions]).assign(subset=subset)
        for subset, rows in arm.items()
    ]
    table = pd.concat(frames)
    split = {"method": "column", "column": "subset"}
    entry = {"file": "arm.csv", "commands": commands, "positions": positions, "split": split, "position_unit": "mm"}
    text = table.to_csv(index=False)
    bad = [
        (text, entry | {"commands": [*commands, "u3"]}),
        (text.replace("validation", "elsewhere"), entry),
        (table.assign(u1="fast").to_csv(index=False), entry),
        (text.splitlines()[0], entry),
        ("", entry),
    ]
    return Example(text, entry, arm, tuple(bad))


def of_a_recipe() -> Example:
    recipe = {"robot": "pneumatic_arm", "seed": 3, "rows": SIZES}
    bad = [json.dumps(recipe | fault) for fault in ({"robot": "walker"}, {"rows": {"train": 5}})]
    return Example(json.dumps(recipe), {"file": "arm.json"}, None, tuple((text, {"file": "arm.json"}) for text in bad))


#: Of each format of the registry.
EXAMPLES = {"kinn_json": of_published_json, "table_file": of_a_table, "simulated": of_a_recipe}


def gives_the_samples_of_every_subset(example: Example, read: Callable[..., dict[str, Samples]]) -> None:
    samples = read(example.text, example.entry)
    assert list(samples) == list(SUBSETS)
    for subset, rows in samples.items():
        assert rows.commands.shape == (SIZES[subset], samples[SUBSETS[0]].commands.shape[1])
        assert rows.positions.shape == (SIZES[subset], samples[SUBSETS[0]].positions.shape[1])
        assert rows.positions.shape[1] % 3 == 0
        for array in (rows.commands, rows.positions):
            assert array.dtype == np.float64
            assert np.isfinite(array).all()


def gives_what_the_file_holds(example: Example, read: Callable[..., dict[str, Samples]]) -> None:
    """To the bit, in the order of the file."""
    samples, again = (read(example.text, example.entry) for _ in range(2))
    for subset, rows in (example.holds or again).items():
        np.testing.assert_array_equal(samples[subset].commands, rows.commands)
        np.testing.assert_array_equal(samples[subset].positions, rows.positions)


def refuses_what_is_no_such_file(example: Example, read: Callable[..., dict[str, Samples]]) -> None:
    """With the error that a person can fix."""
    for text, entry in example.bad:
        try:
            read(text, entry)
        except SoftkinError:
            continue
        raise AssertionError("read what is no such file")


LAWS = (gives_the_samples_of_every_subset, gives_what_the_file_holds, refuses_what_is_no_such_file)


def check_reader(reader: Reader, example: Example, folder: Path) -> None:
    for law in LAWS:
        keep(law, reader, example, folder)


def keep(law: Callable[[Example, Any], None], reader: Reader, example: Example, folder: Path) -> None:
    """The law holds, and neither the file nor a global random state is touched by reading."""

    def read(text: str, entry: Mapping[str, Any]) -> dict[str, Samples]:
        path = folder / "raw"
        path.write_text(text, encoding="utf-8")
        before = sha256_of([path])
        with laws.global_random_states_kept():
            samples = reader(path, dataset="arm", source=entry)
        assert sha256_of([path]) == before
        return samples

    law(example, read)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", READERS)
def test_every_reader_keeps_the_contract(name: str, law: Callable[[Example, Any], None], tmp_path: Path) -> None:
    keep(law, READERS[name], EXAMPLES[name](), tmp_path)


def changed(change: Callable[[dict[str, Samples]], object]) -> Reader:
    """The reader of a table, of whose samples something is changed."""

    def read(path: Path, *, dataset: str, source: Mapping[str, Any]) -> Any:
        return change(READERS["table_file"](path, dataset=dataset, source=source))

    return read


def reversed_rows(samples: dict[str, Samples]) -> dict[str, Samples]:
    return {subset: Samples(rows.commands[::-1], rows.positions) for subset, rows in samples.items()}


def in_metres(samples: dict[str, Samples]) -> dict[str, Samples]:
    return {subset: Samples(rows.commands, rows.positions / 1000.0) for subset, rows in samples.items()}


def single_precision(samples: dict[str, Samples]) -> dict[str, Any]:
    return {subset: replace(rows, commands=rows.commands.astype(np.float32)) for subset, rows in samples.items()}


def forgiving(path: Path, *, dataset: str, source: Mapping[str, Any]) -> dict[str, Samples]:
    try:
        return READERS["table_file"](path, dataset=dataset, source=source)
    except SoftkinError:
        return four_subsets(SIZES, n_commands=2, n_markers=2)


def rewriting(path: Path, *, dataset: str, source: Mapping[str, Any]) -> dict[str, Samples]:
    samples = READERS["table_file"](path, dataset=dataset, source=source)
    path.write_text("read")
    return samples


@pytest.mark.parametrize(
    ("law", "reader"),
    [
        (gives_the_samples_of_every_subset, changed(lambda samples: {"train": samples["train"]})),
        (gives_the_samples_of_every_subset, changed(single_precision)),
        (gives_the_samples_of_every_subset, rewriting),
        (gives_what_the_file_holds, changed(reversed_rows)),
        (gives_what_the_file_holds, changed(in_metres)),
        (refuses_what_is_no_such_file, forgiving),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[Example, Any], None], reader: Reader, tmp_path: Path) -> None:
    with pytest.raises(AssertionError):
        keep(law, reader, of_a_table(), tmp_path)
    with pytest.raises(AssertionError):
        check_reader(reader, of_a_table(), tmp_path)
