from __future__ import annotations

import json
import logging
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from softkin.core.credentials import KEPT
from softkin.core.errors import SoftkinError
from softkin.core.job import Discreet, job
from softkin.core.terminal import ON_A_SCREEN

CLOCK = r"[0-2]\d:[0-5]\d:[0-5]\d"


def test_bad_input_ends_with_its_message_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "logs" / "job.log"
    with pytest.raises(SystemExit) as end, job(str(log), "prepare finger"):
        raise SoftkinError("no value", where="row 7", fix="fill the cell")
    assert end.value.code == 1
    assert "row 7: no value" in log.read_text()
    printed = capsys.readouterr().err
    assert re.fullmatch(rf"{CLOCK} prepare finger: row 7: no value\n  fix: fill the cell\n", printed)


def test_a_defect_keeps_its_traceback(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), job(str(tmp_path / "job.log"), "x"):
        1 / 0  # noqa: B018
    assert "Traceback" in (tmp_path / "job.log").read_text()


def test_a_damaged_input_is_the_message_and_the_traceback_is_in_the_log(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "table.parquet"
    table.write_bytes(b"garbage")
    with pytest.raises(SystemExit) as end, job(str(tmp_path / "job.log"), "fit", inputs=[str(table)]):
        raise KeyError("m1_x")
    assert end.value.code == 1
    printed = capsys.readouterr().err
    assert f"{table}: this result is damaged" in printed
    assert "fix: delete the file and run again" in printed
    assert "Traceback" not in printed
    assert "KeyError: 'm1_x'" in (tmp_path / "job.log").read_text()


def test_a_defect_with_sound_inputs_is_still_one(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("{}\n")
    with pytest.raises(KeyError), job(str(tmp_path / "job.log"), "fit", inputs=[str(tmp_path / "a.json")]):
        raise KeyError("m1_x")


def test_an_interrupt_is_not_explained(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), job(str(tmp_path / "job.log"), "fit", inputs=[str(tmp_path / "no.json")]):
        raise KeyboardInterrupt


def test_debug_goes_to_the_log_only(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with job(str(tmp_path / "job.log"), "tune"):
        logging.getLogger("softkin").debug("trial 3")
        logging.getLogger("softkin").info("half done")
    assert re.fullmatch(rf"{CLOCK} tune: half done\n", capsys.readouterr().err)
    assert "trial 3" in (tmp_path / "job.log").read_text()


def test_the_log_is_as_before_when_a_job_ends(tmp_path: Path) -> None:
    """A handler that outlives its job would write to streams that are closed by then."""
    with job(str(tmp_path / "a.log"), "a"):
        assert len(logging.getLogger("softkin").handlers) == 2
    assert logging.getLogger("softkin").handlers == []
    assert logging.getLogger("softkin").propagate
    assert not any(isinstance(handler.formatter, Discreet) for handler in logging.getLogger().handlers)


def test_under_a_screen_everything_goes_to_the_log(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(ON_A_SCREEN, "1")
    with job(str(tmp_path / "job.log"), "tune"):
        logging.getLogger("softkin").info("half done")
        os.system("echo a library wrote this")
    assert capfd.readouterr() == ("", "")
    assert "half done" in (tmp_path / "job.log").read_text()
    assert "a library wrote this" in (tmp_path / "job.log").read_text()
    os.system("echo afterwards")
    assert capfd.readouterr().out == "afterwards\n"


def test_credentials_stand_in_no_log_and_no_traceback(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    url = "http://me:hunter22@example.org/"
    monkeypatch.setenv(KEPT, json.dumps({"http://***@example.org/": url}))
    monkeypatch.setattr(sys, "excepthook", sys.__excepthook__)

    def work() -> None:
        logging.getLogger("softkin").info("the store is %s", url)
        raise OSError(f"no connection to {url}")

    with pytest.raises(OSError, match="example") as defect, job(str(tmp_path / "job.log"), "track"):
        work()
    sys.excepthook(defect.type, defect.value, defect.tb)
    shown = (tmp_path / "job.log").read_text() + capsys.readouterr().err
    assert shown.count("the store is http://***@example.org/") == 2
    assert shown.count("OSError: no connection to http://***@example.org/") == 2
    assert "hunter22" not in shown


def test_what_libraries_log_is_not_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """MAPIE 1.6 sets up the root logger, if nobody has, to say that quantiles cross."""
    root = logging.getLogger()
    before = root.handlers
    root.handlers = []
    try:
        with job(str(tmp_path / "j.log"), "fit x"):
            logging.basicConfig(level=logging.INFO)
            logging.info("The predictions are ill-sorted.")
            logging.getLogger("library").warning("a warning of a library")
        assert root.handlers == []
    finally:
        root.handlers = before
    assert "ill-sorted" not in capsys.readouterr().err
    assert "a warning of a library" in (tmp_path / "j.log").read_text()


def test_who_imports_softkin_to_use_it_keeps_pythons_own_collections() -> None:
    told = "import gc, softkin.uncertainty.calibrated_model; print(gc.get_threshold()[0] < 20_000)"
    told += "; import softkin.core.job; print(gc.get_threshold()[0])"
    said = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True).stdout
    assert said.split() == ["True", "20000"]
