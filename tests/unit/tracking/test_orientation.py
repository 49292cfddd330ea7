from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.files import write_json
from softkin.tracking.orientation import log_orientation
from softkin.tracking.records import CURRENT, YES, find
from softkin.tracking.store import Campaign
from tests.unit.tracking.conftest import DESCRIPTION


def test_its_scores_are_a_run_until_the_entry_names_it_no_more(
    tmp_path: Path, campaign: Campaign, client: Any, experiment: str
) -> None:
    rows = [("test", 0.8, 2.0, 0.75), ("test", 0.9, float("inf"), 1.0)]
    scores = pd.DataFrame(rows, columns=["subset", "confidence_level", "bound_deg", "coverage"])
    scores.assign(dataset="finger", model="gp", mean_deg=1.0, rms_deg=1.5).to_csv(tmp_path / "o.csv", index=False)
    of: dict[str, Any] = {"description": tmp_path / "dataset.json", "data_card": tmp_path / "data_card.json"}
    write_json(of["description"], DESCRIPTION)
    write_json(of["data_card"], {"findings": []})

    run_id = log_orientation(campaign, **of, scores=tmp_path / "o.csv", parent="p")
    assert log_orientation(campaign, **of, scores=tmp_path / "o.csv", parent="p") == run_id
    run = client.get_run(run_id)
    assert run.data.metrics["test/orientation_rms_deg"] == 1.5
    assert run.data.metrics["test/orientation_coverage_80"] == 0.75
    assert run.data.tags["infinite"] == "test/orientation_bound_deg_90"
    assert log_orientation(campaign, **of, scores=None, parent="p") is None
    assert find(client, experiment, kind="orientation", **{CURRENT: YES}) == []
