"""Small robots for every test, made here: no test needs the network, nor the published files unless it says so."""

from __future__ import annotations

import gc
import hashlib
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import settings

from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import to_table, write_table

# Hardly any of what the tests make is garbage in circles: looking for it took 5 to 12 % of their time.
gc.set_threshold(1_000_000)

# How long an example takes says nothing of a law: a loaded machine is slow.
settings.register_profile("softkin", deadline=None)
settings.load_profile("softkin")

HOUSE = Path(__file__).parent.parent
KEYS = {"train": "train", "validation": "val", "test": "test", "extrapolation": "ext"}


def bending_arm(
    n_rows: int, n_commands: int = 2, n_markers: int = 1, seed: int = 0, largest_command: float = 1.0
) -> Samples:
    """Constant-curvature arcs, 100 mm long, noise 0.1 mm; the first of several markers is the base and never moves."""
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-largest_command, largest_command, (n_rows, n_commands))
    first, second = commands[:, 0], commands[:, -1]
    bend = np.hypot(first, second) + 1e-9
    positions = []
    for length in np.linspace(0.0, 100.0, n_markers) if n_markers > 1 else (100.0,):
        angle = bend * length / 100.0
        out = length * np.where(angle > 1e-6, (1 - np.cos(angle)) / np.maximum(angle, 1e-6), angle / 2)
        up = length * np.where(angle > 1e-6, np.sin(angle) / np.maximum(angle, 1e-6), 1.0)
        marker = np.column_stack([out * first / bend, out * second / bend, up])
        positions.append(marker + (0.1 * rng.standard_normal(marker.shape) if length else 0.0))
    return Samples(commands, np.hstack(positions))


def published_json(subsets: dict[str, Samples], factor: float = 1.0) -> dict[str, Any]:
    """As the authors publish it; positions divided by `factor`."""
    return {
        KEYS[subset]: {
            "motor_control": rows.commands.tolist(),
            "position": (rows.positions / factor).reshape(len(rows), -1, 3).tolist(),
        }
        for subset, rows in subsets.items()
    }


def four_subsets(sizes: dict[str, int], **arm: int) -> dict[str, Samples]:
    return {
        subset: bending_arm(size, seed=place, largest_command=1.5 if subset == "extrapolation" else 1.0, **arm)
        for place, (subset, size) in enumerate(sizes.items())
    }


@pytest.fixture
def samples() -> Samples:
    return bending_arm(120)


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """A prepared table of one marker."""
    path = tmp_path / "table.parquet"
    write_table(to_table(four_subsets(dict.fromkeys(SUBSETS, 40))), path)
    return path


@pytest.fixture(scope="session")
def mirror(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A mirror with made-up files under the published names, and `override.yaml` that registers their hashes."""
    folder = tmp_path_factory.mktemp("mirror")
    sources = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
    override: dict[str, Any] = {"sources": {}}
    for name, source in sources.items():
        if "urls" not in source:  # somebody's own robot
            continue
        arm = {"n_commands": source["n_commands"], "n_markers": source["n_markers"]}
        factor = {"m": 1000.0, "mm": 1.0}[source["position_unit"]]
        content = json.dumps(published_json(four_subsets(source["rows"], **arm), factor)).encode()
        (folder / source["file"]).write_bytes(content)
        override["sources"][name] = {"sha256": hashlib.sha256(content).hexdigest()}
    (folder / "override.yaml").write_text(yaml.safe_dump(override))
    return folder


@pytest.fixture(scope="session")
def published_mirror() -> Path:
    """The published files, where the machine has them."""
    folder = os.environ.get("SOFTKIN_DATA_MIRROR", "")
    if not (Path(folder) / "FINGER.json").is_file():
        pytest.skip("the published datasets are not here: set SOFTKIN_DATA_MIRROR to a folder that holds them")
    return Path(folder)
