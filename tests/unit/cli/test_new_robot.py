from __future__ import annotations

import io
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from softkin.cli.new_robot import main
from softkin.core.configuration import check_configuration
from softkin.data.readers import READERS
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.quantile import QUANTILE_MODELS
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.regions import REGION_METHODS
from tests.conftest import HOUSE
from tests.nasty import NASTY
from tests.unit.cli.tables import columns


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "config").mkdir()
    for name in ("config.yaml", "datasets.yaml"):
        shutil.copy(HOUSE / "config" / name, tmp_path / "config" / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def guess(capsys: pytest.CaptureFixture[str], table: pd.DataFrame, *options: str) -> dict[str, Any]:
    table.to_csv("Soft Arm-1.csv", index=False)
    assert main(["Soft Arm-1.csv", *options]) == 0
    entries: dict[str, dict[str, Any]] = yaml.safe_load(capsys.readouterr().out)
    return next(iter(entries.values()))


def test_without_write_the_entry_is_shown_and_nothing_is_changed(
    house: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    entry = guess(capsys, columns("u1", "u2", "x", "y", "z"))
    assert entry["title"] == "Soft arm 1"
    assert entry["file"] == "Soft Arm-1.csv"
    assert (house / "config" / "datasets.yaml").read_bytes() == (HOUSE / "config" / "datasets.yaml").read_bytes()


def test_write_appends_and_keeps_every_letter_before(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    datasets = house / "config" / "datasets.yaml"
    before = datasets.read_text()
    entry = guess(capsys, columns("u1", "u2", "x", "y", "z"), "--write", "--name", "my_arm")
    after = datasets.read_text()
    assert after.startswith(before)
    assert yaml.safe_load(after)["sources"] == yaml.safe_load(before)["sources"] | {"my_arm": entry}
    config = yaml.safe_load((house / "config" / "config.yaml").read_text()) | yaml.safe_load(after)
    registries: dict[str, Any] = {
        "models": MODELS,
        "ensembles": ENSEMBLES,
        "formats": READERS,
        "interval_methods": INTERVAL_METHODS,
    }
    registries |= {"quantile_models": QUANTILE_MODELS, "regions": REGION_METHODS, "standins": STANDINS}
    schema = HOUSE / "workflow" / "schemas" / "config.schema.yaml"
    check_configuration(config | {"datasets": ["my_arm"]}, schema, registries)


def test_it_says_what_to_add_to_the_configuration(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    columns("u1", "x", "y", "z").to_parquet(house / "arm.parquet")
    assert main(["arm.parquet", "--write"]) == 0
    said = capsys.readouterr().err
    datasets = yaml.safe_load((house / "config" / "config.yaml").read_text())["datasets"]
    assert f"datasets: [{', '.join([*datasets, 'arm'])}]" in said
    assert "train 112, validation 14, test 14, extrapolation 60" in said
    assert main(["arm.parquet"]) == 0
    assert "--write" in capsys.readouterr().err


def test_a_question_shows_both_entries_and_is_never_answered_silently(
    house: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (house / "config" / "datasets.yaml").read_bytes()
    shutil.copy(HOUSE / "tests" / "cases" / "21_pixels_two_frames.csv", "arm.csv")
    assert main(["arm.csv"]) == 0
    shown = capsys.readouterr()
    entries = yaml.safe_load(shown.out)
    assert [entry["positions"] for entry in entries.values()] == [["tip_x", "tip_y"], ["tip_x_img", "tip_y_img"]]
    assert "Question: tip_x_img, tip_y_img are tip_x, tip_y in another frame" in shown.err
    assert "ANSWER=1 or 2" in complaint(capsys, "arm.csv", "--write")
    assert (house / "config" / "datasets.yaml").read_bytes() == before
    assert main(["arm.csv", "--answer", "2", "--write"]) == 0
    assert list(yaml.safe_load(capsys.readouterr().out)) == ["arm"]


def test_the_guess_is_shown_before_a_file_is_refused(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = columns("u1", "u2", "x", "y", "z").astype(object)
    table.loc[150, "z"] = "broken"
    table.to_csv(house / "arm.csv", index=False)
    assert main(["arm.csv", "--write"]) == 2
    shown = capsys.readouterr()
    assert yaml.safe_load(shown.out)["arm"]["commands"] == ["u1", "u2"]
    assert "no number: 'broken'" in shown.err


def test_a_file_elsewhere_is_named_in_full(
    tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path_factory.mktemp("elsewhere") / "arm.csv"
    columns("u1", "x", "y", "z").to_csv(path, index=False)
    assert main([str(path)]) == 0
    assert yaml.safe_load(capsys.readouterr().out)["arm"]["file"] == str(path)


def complaint(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert "Traceback" not in said
    assert "fix: " in said
    return said


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "the file is empty"),
        ("u1,x,y,z\n", "a header, but no row"),
        ("1,2,3,4\n", "no header"),
        ("u1,x,y,z\n1,2,3,a\n", "line 2, column 'z': no number: 'a'"),
        ("u1,x,y,z\n1,2,3,4\n", "1 distinct command, but four subsets"),
        ("u1,a,b\n1,2,3\n", "no columns look like positions: u1, a, b"),
        ("t,x,y,z\n1,2,3,4\n", "no column looks like a command: t, x, y, z"),
        ("u1,x_m,y_mm,z_mm\n1,2,3,4\n", "positions in different units"),
    ],
)
def test_a_bad_file_ends_with_a_message_and_status_2(
    house: Path, capsys: pytest.CaptureFixture[str], content: str, says: str
) -> None:
    (house / "arm.csv").write_text(content)
    assert says in complaint(capsys, "arm.csv", "--write")
    assert (house / "config" / "datasets.yaml").read_bytes() == (HOUSE / "config" / "datasets.yaml").read_bytes()


def test_bad_arguments_and_files_of_datasets_are_errors(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    columns("u1", "x", "y", "z").to_csv("1st.csv", index=False)
    datasets = house / "config" / "datasets.yaml"
    assert "no such file: ''" in complaint(capsys, "")
    assert "no such file: 'config'" in complaint(capsys, "config")
    assert "'1st' is no name" in complaint(capsys, "1st.csv")
    assert "'A b' is no name" in complaint(capsys, "1st.csv", "--name", "A b")
    assert "there is an entry 'finger' already" in complaint(capsys, "1st.csv", "--name", "finger", "--write")
    datasets.write_text("sources:\n  a: {title: A}\nlast: 1\n")
    assert "`sources` is not its last key" in complaint(capsys, "1st.csv", "--name", "arm", "--write")
    with pytest.raises(SystemExit) as stop:
        main([])
    assert stop.value.code == 2


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(header=st.lists(st.text("uxyztm_1 ,;'\"#:[]\n", max_size=4), min_size=1, max_size=6), rows=st.integers(0, 30))
def test_any_header_gives_an_entry_or_a_message(house: Path, header: list[str], rows: int) -> None:
    rng = np.random.default_rng(rows)
    pd.DataFrame(rng.normal(size=(rows, len(header))), columns=header).to_csv(house / "arm.csv", index=False)
    assert main(["arm.csv"]) in (0, 2)


def test_messages_go_to_the_present_stderr_at_every_call(
    house: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A handler that outlives its call would write to a stream that is closed by then."""
    assert house
    with io.StringIO() as first, monkeypatch.context() as patched:
        patched.setattr("sys.stderr", first)
        guess(capsys, columns("u1", "u2", "x", "y", "z"))
        assert "INFO: read as utf-8" in first.getvalue()
    columns("u1", "u2", "x", "y", "z").to_csv("Soft Arm-1.csv", index=False)
    assert main(["Soft Arm-1.csv"]) == 0
    messages = capsys.readouterr().err
    assert "INFO: read as utf-8" in messages
    assert "Logging error" not in messages


def test_names_of_files_and_columns_are_text(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In the entry, in the comments above it, and in the file of datasets; the name of the file is no command."""
    table = columns("u1", "u2", "x", "y", "z").assign(**{f"id {NASTY}": 1.0, "id: &a [*b\u2028injected: 1": 2.0})
    name = f"-{NASTY}".replace("/", "_")[:200] + ".csv"
    table.to_csv(name, index=False)
    assert main(["--name", "arm", "--write", "--", name]) == 0
    entry = yaml.safe_load(capsys.readouterr().out)["arm"]
    written = yaml.safe_load((house / "config" / "datasets.yaml").read_text())
    assert entry["file"] == name
    assert written["sources"]["arm"] == entry
    assert set(written) == {"sources"}


def test_commands_and_positions_in_two_files_become_one_entry(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = columns("u1", "u2", "x", "y", "z").assign(ID=range(200))
    table[["ID", "u1", "u2"]].to_csv("my commands.csv", index=False)
    table[["ID", "x", "y", "z"]].to_csv("take.csv", index=False)
    assert main(["my commands.csv", "take.csv", "--name", "arm", "--write"]) == 0
    shown = capsys.readouterr()
    entry = yaml.safe_load(shown.out)["arm"]
    # Each file is read again and again, and each message is shown once, with the name of its file.
    for name in ("my commands.csv", "take.csv"):
        assert shown.err.count(f"INFO: read as utf-8, columns split by comma, decimal points: {name}\n") == 1
    assert shown.err.count("read as") == 2
    assert entry["files"] == ["my commands.csv", "take.csv"]
    assert entry["join"] == {"by": "column", "column": "ID"}
    assert "file" not in entry
    assert yaml.safe_load((house / "config" / "datasets.yaml").read_text())["sources"]["arm"] == entry
