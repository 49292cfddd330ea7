"""Log the scores of the model of the tip's orientation: a run of its own, nested under that of the campaign."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from softkin.core.csv_tables import csv_of, read_csv
from softkin.core.escaping import markdown_text
from softkin.core.samples import TEST
from softkin.tracking.records import CURRENT, YES, Record, find, put, retire
from softkin.tracking.store import (
    NOTE,
    PARENT,
    Campaign,
    caution_content,
    caution_note,
    client_of,
    common_tags,
    experiment_of,
    read_description,
)

KIND = "orientation"


def log_orientation(
    campaign: Campaign, *, description: str | Path, data_card: str | Path, scores: str | Path | None, parent: str
) -> str | None:
    """Log the scores of a dataset's orientation; return the id of the run, None where it has none.

    Parameters:
        campaign: the run of the workflow.
        description: dataset.json.
        data_card: data_card.json.
        scores: orientation.csv; None: the dataset's entry names no orientation, and a run of an earlier entry retires.
        parent: id of the run that groups the runs of the dataset.
    """
    client = client_of(campaign.tracking_uri)
    described = read_description(description, data_card)
    experiment = experiment_of(client, described["dataset"])
    there = find(client, experiment, campaign=campaign.name, kind=KIND, **{CURRENT: YES})
    if scores is None:
        retire(client, there, ())
        return None
    table = read_csv(scores)
    tags = common_tags(campaign, described)
    test = table[table["subset"] == TEST].iloc[0]
    note = (
        f"**{markdown_text(described['title'])}**, orientation of the tip by {test.model}: {test.mean_deg:.3g} degrees "
    )
    note += f"off on average on test, {test.rms_deg:.3g} RMS."
    record = Record(
        key=f"{campaign.name}/{described['dataset']}/{KIND}",
        name=f"{described['dataset']} · {KIND}",
        content={"table": csv_of(table), "leak": tags["leak"], **caution_content(campaign)},
        tags={PARENT: parent, **tags, "kind": KIND, "model": test.model, NOTE: note + caution_note(campaign)},
        metrics=metrics_of(table),
        texts={"orientation.csv": csv_of(table)},
        started=campaign.started,
    )
    return put(client, experiment, record, there)


def metrics_of(table: pd.DataFrame) -> dict[str, float]:
    """test/orientation_mean_deg, test/orientation_rms_deg, test/orientation_coverage_90, ..., of orientation.csv."""
    metrics: dict[str, float] = {}
    for row in table.to_dict("records"):
        percent = f"{100 * row['confidence_level']:g}"
        metrics |= {f"{row['subset']}/orientation_{name}": float(row[name]) for name in ("mean_deg", "rms_deg")}
        metrics |= {
            f"{row['subset']}/orientation_{name}_{percent}": float(row[name]) for name in ("bound_deg", "coverage")
        }
    return metrics
