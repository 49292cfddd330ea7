"""Both reports of a complete run."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.workflow.conftest import House
from tests.workflow.test_run import POOL

pytestmark = pytest.mark.timeout(600)


def test_the_page_shows_the_run(house: House) -> None:
    text = (house.work / "results" / "report.html").read_text(encoding="utf-8")
    assert len(text.encode()) < 10_000_000
    assert "campaign test" in text
    assert all(spec.title in text for spec in POOL.values())
    assert text.count('<article class="robot">') == 2
    assert text.count('class="badge rows-left-out"') > 100  # config/test.yaml cuts every subset
    drawn = list((house.work / "results").glob("*/figures/*.png"))
    assert text.count("<img ") == len(drawn) > 0
    assert str(house.work) not in text


def test_snakemakes_own_report_has_captions_and_categories(house: House, tmp_path: Path) -> None:
    status, output = house.looking("--report", str(tmp_path / "report.html"))
    assert status == 0, output
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    for part in ("Overview", "Tables", "Figures", "point_metrics.csv", "intervals_deployed", "job by job"):
        assert part in text
