from __future__ import annotations

from typing import Any

from softkin.tracking.links import link_to, links
from softkin.tracking.store import Campaign, client_of, experiment_of


def test_each_experiment_has_a_link_to_its_runs_and_its_view(campaign: Campaign) -> None:
    client: Any = client_of(campaign.tracking_uri)
    ids = {name: experiment_of(client, name) for name in ("finger", "arm", "champions", "campaigns", "history")}
    found = links(campaign.tracking_uri)
    assert list(found) == ["campaigns", "calibrated models", "nights as curves", "arm", "finger"]
    runs = "runs?workflowType=machine_learning&viewStateShareKey="
    assert found["finger"] == f"/#/experiments/{ids['finger']}/{runs}models_by_error"
    assert link_to(client, "finger") == found["finger"]
    assert found["campaigns"] == f"/#/experiments/{ids['campaigns']}/{runs}nights"
    assert found["calibrated models"] == f"/#/experiments/{ids['champions']}/{runs}champions"


def test_a_store_without_campaigns_has_links_all_the_same(campaign: Campaign) -> None:
    experiment_of(client_of(campaign.tracking_uri), "finger")
    assert list(links(campaign.tracking_uri)) == ["finger"]
