"""The links that `python -m softkin.cli.ui` prints, opened in a real browser."""

from __future__ import annotations

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from softkin.core.files import write_json
from softkin.tracking.champion import log_champion
from softkin.tracking.models import log_dataset
from softkin.tracking.nights import NightRecord, log_night
from softkin.tracking.store import Campaign, client_of
from tests.unit.tracking.robots import champion_files
from tests.unit.tracking.test_nights import summary

sync_api = pytest.importorskip("playwright.sync_api", reason="the Python package playwright is not installed")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed"),
    pytest.mark.slow,  # MLflow's server takes a quarter of a minute to start
    pytest.mark.timeout(900),
]
#: Milliseconds that a page is waited for.
PATIENCE = 240_000
#: Title of a link -> a run that its page shows.
SHOWN = {
    "campaigns": "nightly · 1970-01-01 00:00",
    "calibrated models": "finger · gp · tuned",
    "nights as curves": "nightly · nights",
    "finger": "finger · svr · tuned",
}


@pytest.fixture
def folder(campaign: Campaign, results: dict[str, Any], tmp_path: Path) -> Path:
    """A folder whose store holds a dataset, its calibrated model and a campaign."""
    log_dataset(campaign, **results)
    (tmp_path / "model").mkdir()
    log_champion(campaign, **champion_files(tmp_path / "model"))
    rows = tmp_path / "summary_rows.parquet"
    pd.DataFrame({"dataset": ["finger"], "error_mm": [1.5]}).to_parquet(rows)
    verdict = {"outcome": "same", "exit_code": 0, "duration_seconds": 9.5, "jobs_run": 3}
    log_night(client_of(campaign.tracking_uri), NightRecord(verdict, "A page.", summary(), rows, {}, 1.0))
    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": campaign.tracking_uri})
    return tmp_path


@contextmanager
def served(folder: Path) -> Iterator[dict[str, str]]:
    """The links that are printed, by title, while the UI is served."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "softkin.cli.ui", "--directory", str(folder), "--port", str(port)]
    output = folder / "ui.txt"
    with output.open("w") as file:
        process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        until = time.monotonic() + PATIENCE / 1000
        while True:
            assert process.poll() is None, output.read_text()
            try:
                with urllib.request.urlopen(f"http://127.0.0.1:{port}/health", timeout=5):
                    break
            except OSError:
                assert time.monotonic() < until, output.read_text()
                time.sleep(0.5)
        yield dict(re.findall(r"^  (\S.*?)  +(http\S+)$", output.read_text(), re.MULTILINE))
    finally:
        os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C does
        process.wait(60)


def test_each_link_shows_runs_in_a_table(folder: Path) -> None:
    with served(folder) as links, sync_api.sync_playwright() as playwright:
        assert set(links) == set(SHOWN)
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for title, link in links.items():
            tab = browser.new_page(viewport={"width": 1600, "height": 800})
            tab.goto(link, wait_until="domcontentloaded")
            tab.get_by_text("matching run").wait_for(timeout=PATIENCE)
            tab.get_by_role("link", name=SHOWN[title], exact=True).first.wait_for(timeout=PATIENCE)
            tab.close()
        browser.close()
