"""Take docs/mlflow_ui.png: the models of a robot by error, as the MLflow UI of a finished run shows them.

With `--nights`, docs/nights.png: the numbers of all nights as curves, of a store that has some, such as that of
tests/workflow/test_campaign.py. Needs the store in the working folder, the Python package playwright, and Chromium.
"""

from __future__ import annotations

import argparse
import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Sequence
from pathlib import Path

from mlflow import MlflowClient
from playwright.sync_api import sync_playwright

from softkin.core.errors import StoreError
from softkin.tracking.nights import HISTORY
from softkin.tracking.saved_view import TAG

SECONDS_TO_START = 120


def main() -> None:
    """Serve the store, take the picture and save it."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--dataset", default="finger")
    arguments.add_argument("--nights", action="store_true", help="the curves of all nights")
    arguments.add_argument("--output", type=Path, default=Path("docs/mlflow_ui.png"))
    options = arguments.parse_args()
    if not Path("mlflow.db").exists():
        raise SystemExit(str(StoreError("no such file", where="mlflow.db", fix="`make run` or `make store`")))
    client, wanted = MlflowClient("sqlite:///mlflow.db"), HISTORY if options.nights else options.dataset
    experiment = client.get_experiment_by_name(wanted)
    if experiment is None:
        raise SystemExit(
            str(StoreError("no such experiment", where=wanted, fix="name a dataset of the run: --dataset"))
        )
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"http://127.0.0.1:{free.getsockname()[1]}"
    command = [sys.executable, "-m", "mlflow", "ui", "--host", "127.0.0.1", "--workers", "1"]
    command += ["--port", address.rsplit(":", 1)[1]]
    server = subprocess.Popen(command, env=os.environ | {"MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false"})
    try:
        wait_for(address)
        runs = f"{address}/#/experiments/{experiment.experiment_id}/runs"
        if options.nights:
            (run,) = client.search_runs([experiment.experiment_id], max_results=1)
            photograph(f"{runs}/{run.info.run_id}/model-metrics", options.output, ["Search metric"])
        else:
            view = f"workflowType=machine_learning&viewStateShareKey={TAG.rsplit('.', 1)[1]}"
            photograph(f"{runs}?{view}", options.output, ["matching runs", "Tags"])
    finally:
        server.terminate()
        server.wait(30)


def wait_for(address: str) -> None:
    """Wait until the server answers."""
    until = time.monotonic() + SECONDS_TO_START
    while True:
        try:
            with urllib.request.urlopen(f"{address}/health", timeout=5):
                return
        except OSError:
            if time.monotonic() > until:
                raise
            time.sleep(0.5)


def photograph(page: str, output: Path, texts: Sequence[str]) -> None:
    """Save a picture of the page, its assistant closed, once these texts are there."""
    browsers = ("chromium", "chromium-browser", "google-chrome")
    chromium = next(filter(None, map(shutil.which, browsers)), None)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        tab = browser.new_page(viewport={"width": 1600, "height": 800})
        tab.goto(page, wait_until="domcontentloaded")
        for text in texts:
            tab.get_by_text(text).or_(tab.get_by_placeholder(text)).first.wait_for(timeout=60_000)
        close = tab.get_by_role("button", name="Close")
        for button in reversed(close.all()):
            button.click()
        tab.wait_for_timeout(2000)
        output.parent.mkdir(parents=True, exist_ok=True)
        tab.screenshot(path=output)
        browser.close()


if __name__ == "__main__":
    main()
