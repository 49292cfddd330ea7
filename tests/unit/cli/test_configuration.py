from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.cli.configuration import REGISTRIES, check
from softkin.core.errors import ConfigError
from tests.conftest import HOUSE

FILES = [HOUSE / "config" / name for name in ("config.yaml", "datasets.yaml")]
SCHEMA = HOUSE / "workflow" / "schemas" / "config.schema.yaml"


def configuration() -> dict[str, Any]:
    return {key: value for path in FILES for key, value in yaml.safe_load(path.read_text()).items()}


def test_the_shipped_configuration_passes_all_checks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    check(configuration(), schema=SCHEMA, files=FILES, environment={"SOFTKIN_DATA_MIRROR": "/data"})
    assert all(REGISTRIES.values())


def test_problems_of_all_checks_are_told_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results").touch()
    config = configuration() | {"tracking_uri": "mlruns", "interval_methods": ["qr"]}
    config["sources"]["finger"]["paper_params"] = {"mlp": {"max_itr": 3}}
    config["sources"]["finger"]["title"] = " "
    with pytest.raises(ConfigError) as error:
        check(config, schema=SCHEMA, files=FILES, environment={"MLFLOW_TRACKING_URI": "ftp://x"})
    for part in ("6 keys", "tracking_uri", "interval_methods", "max_itr", "finger.title", "MLFLOW", "results"):
        assert part in str(error.value)


def test_files_are_named_as_a_person_knows_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(HOUSE)
    with pytest.raises(ConfigError, match=r"configuration \(config/config\.yaml, config/datasets\.yaml\)"):
        check(configuration() | {"seed": -1}, schema=SCHEMA, files=FILES, environment={})
