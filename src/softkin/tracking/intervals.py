"""Log the interval metrics: a run per model, preset and interval method, nested under the run of its model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.csv_tables import in_words, read_csv, text_of
from softkin.core.samples import TEST
from softkin.core.units import own_unit, unit_of
from softkin.tracking.figure_index import content_of, shown_in
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

#: Rows of interval_metrics.csv that become metrics -> what their names start with.
SHOWN = {"mean_informative": "", "joint": "joint_"}
REGIONS = "joint_regions"
#: Milliseconds by which these runs start before the models: the UI loads a hundred runs, newest first.
MODELS_FIRST = 1000
METRICS = (
    *("coverage", "mean_width_mm", "winkler_mm", "winkler_without_gross_mm", "crps_mm", "size_mm"),
    *("infinite_share", "crossing_share"),
)


def log_intervals(
    campaign: Campaign,
    *,
    description: str | Path,
    data_card: str | Path,
    metrics: str | Path,
    figures: str | Path,
    parents: Mapping[str, str],
) -> int:
    """Log the dataset's interval metrics; return how many runs there are.

    QR and CQR are children of the model of their quantile regressor's name.

    Parameters:
        campaign: the run of the workflow.
        description: dataset.json.
        data_card: data_card.json.
        metrics: interval_metrics.csv.
        figures: folder of the dataset's figures, whose index.csv says which run each of them shows.
        parents: 'model/preset' -> run id of the model, as `log_dataset` returns it.
    """
    client = client_of(campaign.tracking_uri)
    described = read_description(description, data_card)
    tags = common_tags(campaign, described)
    experiment = experiment_of(client, described["dataset"])
    shown = shown_in(figures)
    keys, there = set(), find(client, experiment, campaign=campaign.name, kind="intervals", **{CURRENT: YES})
    table = read_csv(metrics)
    written = in_words(table)
    # Python's own strings: the hundreds of parts that follow are taken apart in half the time.
    table = table.astype(dict.fromkeys(table.select_dtypes(exclude="number").columns, object))
    # All shapes of joint region around a model share a run: each has one row per subset and level.
    marginal = set(table.loc[table["coordinate"] == "mean_informative", "interval_method"])
    table["run"] = table["interval_method"].where(table["interval_method"].isin(marginal), REGIONS)
    for (model, preset, method), rows in table.groupby(["model", "preset", "run"]):
        parent = parents.get(f"{model}/{preset}", parents["campaign"])
        key = (str(model), str(preset), str(method))
        text = text_of(written.loc[rows.index])
        record = _record(campaign, tags, key, rows, text, parent, shown.get(key, []))
        put(client, experiment, record, there)
        keys.add(record.key)
    retire(client, there, keys)
    return len(keys)


def _record(
    campaign: Campaign,
    tags: Mapping[str, str],
    key: tuple[str, str, str],
    rows: pd.DataFrame,
    table: str,
    parent: str,
    figures: Sequence[Path],
) -> Record:
    """What MLflow shows of the `rows` of one run, which the text `table` holds, too."""
    model, preset, method = key
    dataset = tags["dataset"]
    return Record(
        key=f"{campaign.name}/{dataset}/{model}/{preset}/{method}",
        name=f"{dataset} · {model} · {preset} · {method}",
        content={
            "table": table,
            "figures": content_of(figures),
            "leak": tags["leak"],
            **own_unit(unit_of(tags)),
            **caution_content(campaign),
        },
        tags={
            PARENT: parent,
            **tags,
            "kind": "intervals",
            "model": model,
            "preset": preset,
            "interval_method": method,
            NOTE: _note(rows, method, unit_of(tags)) + caution_note(campaign),
        },
        metrics=_metrics(rows),
        texts={"interval_metrics.csv": table},
        figures=[str(path) for path in figures],
        started=campaign.started - MODELS_FIRST,
    )


def _metrics(rows: pd.DataFrame) -> dict[str, float]:
    """test/coverage_90, test/joint_coverage_90, extrapolation/winkler_mm_90, ...; those that are defined."""
    values = {}
    for row in rows[rows["coordinate"].isin(SHOWN)].to_dict("records"):
        for metric in METRICS:
            percent = f"{100 * row['confidence_level']:g}"
            kind = f"{row['interval_method']}_" if row["run"] == REGIONS else SHOWN[row["coordinate"]]
            values[f"{row['subset']}/{kind}{metric}_{percent}"] = float(row[metric])
    return {name: value for name, value in values.items() if not np.isnan(value)}


def _note(rows: pd.DataFrame, method: str, unit: str) -> str:
    if method == REGIONS:
        shown = rows[(rows["subset"] == TEST) & (rows["confidence_level"] == rows["confidence_level"].median())]
        sizes = [
            f"{one.interval_method} covers {one.coverage:.1%}, {one.size_mm:.3g} {unit}" for one in shown.itertuples()
        ]
        return f"Regions that hold all moving coordinates at once, on test. {'; '.join(sizes)}."
    shown = rows[(rows["coordinate"] == "mean_informative") & (rows["subset"] == TEST)]
    parts = [f"{row.confidence_level:.0%}: covers {row.coverage:.1%}" for row in shown.itertuples()]
    return f"Intervals by **{method}**, on test, averaged over moving coordinates. {', '.join(parts)}."
