"""What `make run` installs: each package of one version, and by the hashes of its files."""

from __future__ import annotations

import re

from tests.conftest import HOUSE


def test_what_a_run_installs_is_pinned_by_hash() -> None:
    """`pip install -r` refuses every file without one of the hashes as soon as one is named."""
    text = (HOUSE / "environment.txt").read_text()
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    packages = re.split(r"\n(?=\S)", "\n".join(lines))
    assert len(packages) > 100
    for package in packages:
        assert re.fullmatch(r"[\w.-]+==[\w.+-]+( ; [^\\\n]+)?( \\\n    --hash=sha256:[0-9a-f]{64})+", package), package


def test_the_environment_names_no_index() -> None:
    for name in ("environment.txt", "environment-dev.txt"):
        assert not re.search(r"://|--index|--find-links|--trusted-host", (HOUSE / name).read_text())


def test_tests_use_the_versions_that_runs_use() -> None:
    pinned = {}
    for name in ("environment.txt", "environment-dev.txt"):
        pinned[name] = dict(re.findall(r"^([\w.-]+)==([\w.+-]+)", (HOUSE / name).read_text(), re.MULTILINE))
    assert pinned["environment.txt"].items() <= pinned["environment-dev.txt"].items()
