"""The paper's tables, reproduced: a heat map."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from softkin.models import MODELS
from softkin.reporting.figures import CAMPAIGN_FIGURES
from softkin.reporting.figures.drawing import draw
from softkin.reporting.figures.published import frame
from softkin.reporting.figures.spec import CampaignResults


@pytest.fixture
def campaign(tmp_path: Path) -> CampaignResults:
    rows = []
    for model in ("gb", "gp"):
        for subset in ("test", "extrapolation"):
            for metric, printed in (("rmse_mm", "2.00"), ("mae_mm", "1.0"), ("r2", ".900"), ("mape_percent", "8")):
                ours = {"paper_value": float(printed), "tuned_value": 0.95 if metric == "r2" else float(printed) / 4}
                key = {"dataset": "arm", "subset": subset, "model": model, "metric": metric, "printed": printed}
                note = "a copy of train" if subset == "test" else ""
                rows.append(key | ours | {"paper_verdict": "reproduced", "tuned_verdict": "better", "note": note})
    rows[2]["printed"] = "1.000"  # R2: nothing is missing to 1
    pd.DataFrame(rows).to_csv(tmp_path / "comparison.csv", index=False)
    titles = {name: spec.title for name, spec in MODELS.items()}
    return CampaignResults(tmp_path / "comparison.csv", {"arm": "ARM (made up)"}, titles)


def test_ratios_are_below_one_where_ours_is_better(campaign: CampaignResults) -> None:
    rows = frame(campaign)
    ratio = rows.groupby(["preset", "metric"])["ratio"].agg(["min", "max"])
    np.testing.assert_allclose(ratio.loc["paper"], 1.0)
    np.testing.assert_allclose(ratio.loc[("tuned", "rmse_mm")], 0.25)
    np.testing.assert_allclose(ratio.loc[("tuned", "r2")], 0.5)
    assert rows["ratio"].isna().sum() == 2  # divided by nothing, in both presets


def test_it_is_drawn_with_its_notes(campaign: CampaignResults, tmp_path: Path) -> None:
    draw(CAMPAIGN_FIGURES, campaign, tmp_path / "figures")
    with Image.open(tmp_path / "figures" / "published.png") as image:
        assert image.width > 1000
    assert "* arm, test: a copy of train" in (tmp_path / "figures" / "published.svg").read_text()
    assert len(pd.read_csv(tmp_path / "figures" / "index.csv")) == 4


def test_nothing_published_is_nothing_to_draw(campaign: CampaignResults) -> None:
    header = pd.read_csv(campaign.published_comparison).head(0)
    header.to_csv(campaign.published_comparison, index=False)
    assert frame(campaign).empty


def test_one_preset_alone_is_enough(campaign: CampaignResults) -> None:
    table = pd.read_csv(campaign.published_comparison)
    table.drop(columns=["tuned_value", "tuned_verdict"]).to_csv(campaign.published_comparison, index=False)
    assert set(frame(campaign)["preset"]) == {"paper"}
