from __future__ import annotations

from softkin.tables.selection import selection


def test_the_lowest_cross_validated_error_is_chosen_per_dataset() -> None:
    scores = {("a", "lr"): 2.0, ("a", "gp"): 1.0, ("a", "rf"): 3.0, ("b", "lr"): 0.1, ("b", "gp"): 0.1}
    chosen = selection(scores).set_index("dataset")
    assert chosen.loc["a", ["model", "runner_up", "pool"]].tolist() == ["gp", "lr", "gp lr rf"]
    assert chosen.loc["a", "cv_mae_mm"] == 1.0
    assert chosen.loc["b", "model"] == "lr"  # a tie goes to the first


def test_a_pool_of_one_has_no_runner_up() -> None:
    assert selection({("a", "lr"): 2.0})["runner_up"].tolist() == [""]
