"""Old campaigns, and what was superseded before those that stay."""

from __future__ import annotations

import time
from typing import Any

from softkin.tracking.nights import JUDGED_IN, NightRecord, log_night, nights
from softkin.tracking.promotion import nominate, promote
from softkin.tracking.prune import remove, to_remove
from softkin.tracking.records import Record, find, put
from softkin.tracking.store import experiment_of

NAME = "softkin-finger"


def night(client: Any, started: float) -> str:
    return log_night(client, NightRecord({"outcome": "same", "exit_code": 0}, "A page.", None, None, {}, started))


def test_the_last_campaigns_stay_with_all_that_they_show(client: Any) -> None:
    experiment, now = experiment_of(client, "finger"), time.time()

    def logged(error: float) -> str:
        record = Record("nightly/finger/gp", "gp", {"error": error}, {"kind": "model"}, started=int(1000 * now))
        return put(client, experiment, record)

    first, campaigns = logged(1.0), [night(client, now - 1000)]
    second = logged(2.0)
    campaigns.append(night(client, time.time() + 0.5))
    time.sleep(0.6)
    third = logged(3.0)
    campaigns.append(night(client, time.time() + 1000))
    removal = to_remove(client, 2)
    assert [run.info.run_id for run in removal.campaigns] == campaigns[:1]
    # The second was current in a campaign that stays.
    assert [run.info.run_id for run in removal.runs] == [first]
    assert removal.sentences()[-1] == "1 superseded runs"
    remove(client, removal)
    assert {run.info.run_id for run in nights(client)} == set(campaigns[1:])
    assert {run.info.run_id for run in find(client, experiment, kind="model")} == {second, third}
    assert to_remove(client, 2).sentences() == ["0 superseded runs"]
    assert to_remove(client, 99).sentences() == ["0 superseded runs"]


def test_versions_with_an_alias_and_what_they_were_judged_in_stay(client: Any) -> None:
    now = time.time()
    first, middle, last = (night(client, now + later) for later in (1000, 2000, 3000))
    client.create_registered_model(NAME)
    for _ in range(3):
        nominate(client, NAME, str(client.create_model_version(NAME, "file:///none").version))
    promote(client, NAME, "2", "it is better")
    client.set_model_version_tag(NAME, "2", JUDGED_IN, first)
    removal = to_remove(client, 1)
    assert removal.versions == [(NAME, "1")]
    assert [run.info.run_id for run in removal.campaigns] == [middle]
    remove(client, removal)
    assert {str(version.version) for version in client.search_model_versions(f"name = '{NAME}'")} == {"2", "3"}
    assert {run.info.run_id for run in nights(client)} == {first, last}
