"""The paper's Figure 6."""

from __future__ import annotations

from softkin.reporting.figures import FIGURES
from softkin.reporting.figures.spec import DatasetResults


def test_the_papers_figure_has_its_four_methods_sorted_rows_and_misses(results: DatasetResults) -> None:
    frame = FIGURES["intervals_paper"].frame(results)
    assert frame["interval_method"].unique().tolist() == ["qr", "cqr", "scp_mapie", "scp_crepes"]
    assert set(frame["model"]) == {"gb"}
    for _, rows in frame.groupby("interval_method"):
        assert rows["true"].is_monotonic_increasing
        assert (~rows["covered"]).sum() == 10
    chosen = FIGURES["intervals_chosen"].frame(results).drop_duplicates("interval_method").set_index("interval_method")
    assert chosen.loc[["qr", "scp_mapie"], "model"].tolist() == ["gb", "gp"]
    assert set(chosen["preset"]) == {"tuned"}
