from __future__ import annotations

from softkin.tracking.promotion import aliases_of, nominate, promote
from softkin.tracking.store import Campaign
from tests.unit.tracking.conftest import client_of_store

NAME = "softkin-finger"


def test_the_first_candidate_is_champion_and_later_ones_wait(campaign: Campaign) -> None:
    client = client_of_store(campaign)
    client.create_registered_model(NAME)
    for _ in range(2):
        client.create_model_version(NAME, "file:///none")
    nominate(client, NAME, "1")
    assert aliases_of(client, NAME) == {"candidate": "1", "champion": "1"}
    nominate(client, NAME, "2")
    assert aliases_of(client, NAME) == {"candidate": "2", "champion": "1"}
    promote(client, NAME, "2", "nothing got worse")
    assert aliases_of(client, NAME) == {"candidate": "2", "champion": "2"}
    assert client.get_model_version(NAME, "2").tags["promoted_because"] == "nothing got worse"
