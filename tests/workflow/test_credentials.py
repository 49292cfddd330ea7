"""Credentials in the URLs of data and store, through Snakemake."""

from __future__ import annotations

import functools
import http.server
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from tests.workflow.conftest import House, copy_house

pytestmark = pytest.mark.timeout(300)
SECRETS = ("hunter22", "1a2b3c4d", "n1ght0wl")


@pytest.fixture
def server(mirror: Path) -> Iterator[str]:
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            pass

    handler = functools.partial(Quiet, directory=str(mirror))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as running:
        threading.Thread(target=running.serve_forever, daemon=True).start()
        yield f"http://me:hunter22@127.0.0.1:{running.server_port}"
        running.shutdown()


def test_credentials_appear_nowhere(mirror: Path, server: str, tmp_path: Path) -> None:
    """A download that works and a store that cannot be reached: a traceback of MLflow's names its URL."""
    override = yaml.safe_load((mirror / "override.yaml").read_text())
    override["sources"]["finger"]["urls"] = [f"{server}/FINGER.json?token=1a2b3c4d"]
    (tmp_path / "mirror").mkdir()
    (tmp_path / "mirror" / "override.yaml").write_text(yaml.safe_dump(override))
    copy_house(tmp_path / "house")
    house = House(tmp_path / "house", tmp_path / "run", tmp_path / "mirror")
    done = house.forked(
        "results/finger/raw",
        "results/mlflow_store.json",
        "--keep-going",
        more_environment={
            "MLFLOW_TRACKING_URI": "http://me:n1ght0wl@127.0.0.1:9",
            "MLFLOW_HTTP_REQUEST_MAX_RETRIES": "0",
        },
    )
    output = done.stdout + done.stderr
    assert done.returncode != 0
    assert (tmp_path / "run" / "results" / "finger" / "raw").read_bytes() == (mirror / "FINGER.json").read_bytes()
    files = [path for path in (tmp_path / "run").rglob("*") if path.is_file()]
    written = output + "".join(path.read_text(errors="replace") for path in files)
    assert "http://***@127.0.0.1" in written
    for secret in SECRETS:
        assert secret not in written
    # Snakemake keeps params by base64 or as they are.
    assert any(".snakemake/metadata" in str(path) for path in files)
