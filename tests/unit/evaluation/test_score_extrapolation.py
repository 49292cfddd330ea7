from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.runs import Run
from softkin.core.samples import Array
from softkin.data.table import read_subset
from softkin.evaluation.score_extrapolation import COLUMNS, ExtrapolationMethods, score_extrapolation, scores
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.labelled.spec import NO_LABELS

LEVELS = [0.8, 0.9]
RUN, OTHER = Run("gp", "outer"), Run("gb", "paper")


def bounds_around(centres: dict[str, Array], half: float, run: Run) -> pd.DataFrame:
    frames = [
        bounds_frame(np.stack([centre - half, centre + half], axis=-1), subset, level)
        for subset, centre in centres.items()
        for level in LEVELS
    ]
    return pd.concat(frames).assign(**run._asdict())


@pytest.fixture
def files(table: Path, tmp_path: Path) -> Path:
    """Predictions off by up to 1 mm; `scp_mapie` 4 mm wide, which misses x of the first ten rows by 1 mm."""
    rng = np.random.default_rng(0)
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions.iloc[:, 1:] += rng.uniform(-1, 1, (len(predictions), 3))
    predictions.to_parquet(tmp_path / "predictions.parquet")
    centres = {subset: read_subset(table, subset).positions for subset in ("test", "extrapolation")}
    for centre in centres.values():
        centre[:10, 0] += 3.0
    around_runs = [bounds_around(centres, 2.0, run) for run in (RUN, OTHER)]
    pd.concat(around_runs).to_parquet(tmp_path / "scp_mapie.parquet")
    pd.concat(around_runs).to_parquet(tmp_path / "cqr.parquet")
    return tmp_path


def scored(
    table: Path,
    files: Path,
    *,
    methods: tuple[str, ...] = ("scp_mapie", "cqr"),
    labelled: tuple[str, ...] = ("oracle", "few_labels"),
    standardised_norm: bool = False,
) -> pd.DataFrame:
    score_extrapolation(
        table,
        dataset="arm",
        standardised_norm=standardised_norm,
        methods=ExtrapolationMethods(
            methods={name: INTERVAL_METHODS[name] for name in methods},
            intervals={name: files / f"{name}.parquet" for name in methods},
            labelled={name: LABELLED_METHODS[name] for name in labelled},
            confidence_levels=LEVELS,
            seed=0,
        ),
        predictions=dict.fromkeys((RUN, OTHER), files / "predictions.parquet"),
        runs=[RUN],
        output=files / "scores.csv",
    )
    return pd.read_csv(files / "scores.csv", keep_default_na=False, na_values=[""])


def test_a_row_per_method_level_and_subset_of_the_runs_asked_for(table: Path, files: Path) -> None:
    rows = scored(table, files)
    assert rows.columns.tolist() == COLUMNS
    assert set(zip(rows["model"], rows["preset"], strict=True)) == {RUN}
    assert set(rows["interval_method"]) == {"scp_mapie", "oracle", "few_labels"}  # quantiles are around no model
    assert len(rows) == 3 * 2 * 2
    assert set(rows["subset"]) == {"test", "extrapolation"}


def test_known_misses_are_scored(table: Path, files: Path) -> None:
    rows = scored(table, files).set_index(["interval_method", "subset", "confidence_level"])
    for subset in ("test", "extrapolation"):
        row = rows.loc[("scp_mapie", subset, 0.9)]
        assert row["n_rows"] == 40
        assert row["coverage"] == pytest.approx(1 - 10 / 120)
        assert row["joint_coverage"] == pytest.approx(0.75)
        assert row["mean_width_mm"] == pytest.approx(4.0)
        assert row["winkler_mm"] == pytest.approx(4.0 + 20 * 10 / 120)
        assert row["infinite_share"] == 0
        assert (row["labels_used"], pd.isna(row["refused"])) == (NO_LABELS, True)
    assert rows.loc[("scp_mapie", "test", 0.9), "guarantee"] == MARGINAL
    assert rows.loc[("scp_mapie", "extrapolation", 0.9), "guarantee"] == NO_GUARANTEE


def test_every_score_stands_beside_the_oracles(table: Path, files: Path) -> None:
    rows = scored(table, files)
    oracle = rows[rows["interval_method"] == "oracle"].set_index(["subset", "confidence_level"])
    assert (oracle["winkler_ratio_to_oracle"] == 1).all()
    assert (oracle["labels_used"] == "all").all()
    for row in rows.itertuples():
        least = oracle.loc[(row.subset, row.confidence_level), "winkler_mm"]
        assert row.oracle_winkler_mm == least
        assert row.winkler_ratio_to_oracle == pytest.approx(row.winkler_mm / least)
    few = rows[rows["interval_method"] == "few_labels"]
    assert set(few["n_rows"]) == {20}  # of 40, the labels are not scored


def test_where_a_method_refuses_it_has_no_scores(table: Path, files: Path) -> None:
    frame = pd.read_parquet(table)
    few = frame.drop(frame.index[frame["subset"] == "extrapolation"][15:])
    few.to_parquet(files / "few.parquet", index=False)
    predictions = pd.read_parquet(files / "predictions.parquet")
    predictions.loc[few.index].to_parquet(files / "predictions.parquet")
    rows = scored(files / "few.parquet", files, methods=())
    refused = rows[(rows["interval_method"] == "few_labels") & (rows["subset"] == "extrapolation")]
    assert refused["refused"].tolist() == ["15 rows, of which 20 would be labelled"] * 2
    assert refused[["coverage", "winkler_mm", "infinite_share"]].isna().all(axis=None)
    answered = rows.drop(refused.index)
    assert answered["refused"].isna().all()
    assert answered["coverage"].notna().all()


def test_the_norm_decides_which_rows_are_far_out(table: Path, files: Path) -> None:
    """Of two commands one is scaled up: it decides the raw norm alone, and not the standardised one."""
    frame = pd.read_parquet(table)
    frame["u1"] *= 1000
    frame.to_parquet(files / "scaled.parquet", index=False)
    raw, standardised = (
        scored(files / "scaled.parquet", files, labelled=("oracle", "adaptive"), standardised_norm=is_standardised)
        for is_standardised in (False, True)
    )
    by_norm = raw["interval_method"].isin(["adaptive", "oracle"])  # the oracle grows with it
    assert (raw.loc[by_norm, "winkler_mm"] != standardised.loc[by_norm, "winkler_mm"]).any()
    own = [name for name in COLUMNS if "oracle" not in name and not name.startswith("ratio_")]
    pd.testing.assert_frame_equal(raw.loc[~by_norm, own], standardised.loc[~by_norm, own])


def test_constant_coordinates_are_not_scored(table: Path, files: Path) -> None:
    frame = pd.read_parquet(table)
    frame["m1_x"] = 5.0
    frame.to_parquet(files / "constant.parquet", index=False)
    rows = scored(files / "constant.parquet", files).set_index(["interval_method", "subset", "confidence_level"])
    assert rows.loc[("scp_mapie", "test", 0.9), "coverage"] == 1.0  # all misses are in x


def test_scores_of_infinite_intervals() -> None:
    bounds = np.array([[[-np.inf, np.inf], [0.0, 1.0]]])
    of_one_row = scores(np.array([[3.0, 2.0]]), bounds, 0.9, np.array([True, False, True]))
    assert (of_one_row["worst_coordinate"], of_one_row["worst_coverage"]) == ("m1_z", 0.0)
    assert (of_one_row["coverage"], of_one_row["joint_coverage"], of_one_row["infinite_share"]) == (0.5, 0.0, 0.5)
    assert of_one_row["mean_width_mm"] == of_one_row["winkler_mm"] == np.inf


def test_few_distinct_commands_are_not_assessable(table: Path, files: Path) -> None:
    """Twelve commands in 40 rows: had all been covered, 80 % would not be shown."""
    frame = pd.read_parquet(table)
    places = np.flatnonzero(frame["subset"] == "extrapolation")
    frame.loc[places, ["u1", "u2"]] = frame.loc[places % 12 + places[0], ["u1", "u2"]].to_numpy()
    frame.to_parquet(files / "copies.parquet", index=False)
    rows = scored(files / "copies.parquet", files)
    there = rows["subset"] == "extrapolation"
    assert set(rows.loc[there, "n_commands"]) == {12}
    assert not rows.loc[there, "assessable"].any()
    assert rows.loc[~there, "assessable"].all()


def test_gross_errors_are_counted_and_can_be_left_out(table: Path, files: Path) -> None:
    """One row of extrapolation is off by 500 mm; models are not, and miss it."""
    frame = pd.read_parquet(table)
    place = np.flatnonzero(frame["subset"] == "extrapolation")[20]
    frame.loc[place, "m1_y"] += 500.0
    frame.to_parquet(files / "lost.parquet", index=False)
    rows = scored(files / "lost.parquet", files).set_index(["interval_method", "subset", "confidence_level"])
    row = rows.loc[("scp_mapie", "extrapolation", 0.9)]
    assert row["n_gross_rows"] == 1
    assert row["winkler_mm"] > 80
    assert row["winkler_without_gross_mm"] == pytest.approx(4.0 + 20 * 10 / (39 * 3))
    assert rows.loc[("scp_mapie", "test", 0.9), "n_gross_rows"] == 0
    assert row["ratio_low"] <= row["winkler_ratio_to_oracle"] <= row["ratio_high"]
