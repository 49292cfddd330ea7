from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.files import write_json
from softkin.core.runs import Run
from softkin.models.spec import PAPERS_RUN
from softkin.training.selection import (
    OBJECTIVES,
    deployable_runs,
    deployed,
    on_front,
    run_of_choice,
    runs_to_refit,
    runs_with_errors,
    searched_runs,
    selection,
    shell_runs,
)


def runs(*rows: tuple[str, str, float, float], dataset: str = "a") -> pd.DataFrame:
    names = ["model", "preset", "cv_mae_mm", "shell_mae_mm"]
    return pd.DataFrame(rows, columns=names).assign(dataset=dataset, target_space="cartesian")


def test_each_objective_has_its_own_choice_and_the_runner_up_is_another_model() -> None:
    pool = runs(
        ("gp", "tuned", 1.0, 9.0), ("gp", "outer", 1.5, 8.0), ("lr", "outer", 8.0, 2.0), ("mlp", "outer", 2.0, 2.5)
    )
    chosen = selection(pool, "extrapolation").set_index("objective")
    assert chosen["model"].to_dict() == {"interpolation": "gp", "extrapolation": "lr", "both": "mlp"}
    assert chosen["runner_up"].to_dict() == {"interpolation": "mlp", "extrapolation": "mlp", "both": "gp"}
    assert chosen.loc["interpolation", "runner_up_ratio"] == 2.0
    assert chosen.loc["both", "runner_up_ratio"] == pytest.approx(3 / 5**0.5)
    assert chosen.loc["interpolation", "pool"] == "gp mlp lr"
    assert deployed(selection(pool, "extrapolation"))["model"].tolist() == ["lr"]


def test_one_model_has_no_runner_up_and_ties_go_to_the_first() -> None:
    assert selection(runs(("lr", "tuned", 2.0, 2.0)), "both")["runner_up"].tolist() == [""] * 3
    tied = selection(runs(("lr", "tuned", 2.0, 2.0), ("gp", "tuned", 2.0, 2.0)), "both")
    assert set(tied["model"]) == {"lr"}


def test_without_a_score_on_shells_there_is_a_choice_for_interpolation_only() -> None:
    assert selection(runs(("lr", "tuned", 2.0, np.nan)), "interpolation")["objective"].tolist() == ["interpolation"]


@given(st.lists(st.tuples(st.floats(0, 10), st.floats(0, 10)), min_size=1, max_size=12))
def test_nothing_on_the_front_is_beaten_and_all_else_is(scores: list[tuple[float, float]]) -> None:
    pool = runs(*(("lr", "tuned", *pair) for pair in scores))
    front = on_front(pool)
    for one, kept in zip(scores, front, strict=True):
        beaten = any(a <= one[0] and b <= one[1] and (a, b) != one for a, b in scores)
        assert kept == (not beaten)
    best = OBJECTIVES["both"](pool).idxmin()
    assert front[best]


def test_the_scores_are_read_from_the_files_of_best_parameters(tmp_path: Path) -> None:
    write_json(tmp_path / "a.json", {"target_space": "curvature", "cv_mae_mm": 1.0, "shell_mae_mm": 2.0, "params": {}})
    write_json(tmp_path / "b.json", {"target_space": "cartesian", "cv_mae_mm": 3.0})
    write_json(tmp_path / "c.json", {"target_space": "curvature", "cv_mae_mm": 3.0, "shell_mae_mm": None})
    models = {"lr": "a", "gp": "b", "svr": "c"}
    files = {("d", model, "tuned"): tmp_path / f"{name}.json" for model, name in models.items()}
    scores = searched_runs(files)
    assert scores["shell_mae_mm"].tolist() == pytest.approx([2.0, np.nan, np.inf], nan_ok=True)
    assert scores["target_space"].tolist() == ["curvature", "cartesian", "curvature"]


def test_a_score_in_the_order_of_the_errors_has_the_rank_correlation_one() -> None:
    scores = {"lr": (5.0, 1.0), "gp": (4.0, 20.0), "svr": (3.0, 30.0), "rf": (2.0, 40.0), "gb": (1.0, 500.0)}
    pool = runs(*((model, "tuned", *scores[model]) for model in scores))
    errors = {"lr": 5.0, "gp": 6.0, "svr": 7.0, "rf": 8.0, "gb": 90.0}
    point = pd.DataFrame(
        [
            {"dataset": "a", "model": model, "preset": "tuned", "subset": subset, "mae_mm": error}
            for model, error in errors.items()
            for subset in ("test", "extrapolation")
        ]
    )
    scored = runs_with_errors(pool, point)
    assert scored["extrapolation_mae_mm"].tolist() == list(errors.values())
    assert scored["shell_rank_correlation"].tolist() == pytest.approx([1.0] * 5)
    assert scored["cv_rank_correlation"].tolist() == pytest.approx([-1.0] * 5)
    fewer = runs_with_errors(pool[pool["model"] != "gb"], point)
    assert fewer[["shell_rank_correlation", "cv_rank_correlation"]].isna().to_numpy().all()


def test_which_runs_no_other_beats_is_marked_dataset_by_dataset() -> None:
    best, worse, alone = ("lr", "tuned", 1.0, 1.0), ("gp", "tuned", 2.0, 2.0), ("gp", "tuned", 9.0, 9.0)
    pool = pd.concat([runs(best, worse), runs(alone, dataset="b")], ignore_index=True)
    subsets = ("test", "extrapolation")
    point = pd.concat([pool.assign(subset=subset, mae_mm=pool["cv_mae_mm"]) for subset in subsets])
    scored = runs_with_errors(pool, point)
    assert scored["on_front"].tolist() == [True, False, True]


@pytest.fixture
def best_parameters(tmp_path: Path) -> dict[Run, Path]:
    """Files of best parameters of three runs."""
    files = {}
    for model, scores in {"lr": (0.5, 1.0), "gp": (0.1, 9.0), "svr": (0.1, 9.0)}.items():
        files[Run(model, "tuned")] = tmp_path / f"{model}.json"
        best = dict(zip(("cv_mae_mm", "shell_mae_mm"), scores, strict=True))
        write_json(files[Run(model, "tuned")], best | {"target_space": "cartesian"})
    return files


def test_the_run_of_choice_is_the_one_of_lowest_score_by_the_objective(best_parameters: dict[Run, Path]) -> None:
    assert run_of_choice(best_parameters, "interpolation") == ("gp", "tuned")
    assert run_of_choice(best_parameters, "extrapolation") == ("lr", "tuned")


def test_the_papers_run_the_chosen_one_and_robust_ones_get_shells(best_parameters: dict[Run, Path]) -> None:
    pool = [PAPERS_RUN, Run("svr", "outer"), Run("ridge", "outer"), Run("ridge", "tuned"), *best_parameters]
    chosen = Run("gp", "tuned")
    shells = shell_runs(pool, best_parameters, "interpolation", ["ridge", "huber"])
    assert shells == [PAPERS_RUN, chosen, Run("ridge", "outer")]  # there is no run of huber
    assert shell_runs(pool, best_parameters, "interpolation", []) == [PAPERS_RUN, chosen]
    assert shell_runs(pool, {}, "interpolation", ["ridge"]) == [PAPERS_RUN, Run("ridge", "outer")]
    assert shell_runs([chosen], best_parameters, "interpolation", ["ridge"]) == [chosen]


def test_the_papers_run_and_the_chosen_one_are_refitted_where_their_models_are_cheap(
    best_parameters: dict[Run, Path],
) -> None:
    pool, chosen = [PAPERS_RUN, *best_parameters], run_of_choice(best_parameters, "interpolation")
    cheap = [PAPERS_RUN.model, chosen.model]
    assert deployable_runs(pool, best_parameters, "interpolation") == [chosen]
    assert runs_to_refit(pool, best_parameters, "interpolation", cheap) == [PAPERS_RUN, chosen]
    assert runs_to_refit(pool, best_parameters, "interpolation", [PAPERS_RUN.model]) == [PAPERS_RUN]
    assert runs_to_refit([chosen], best_parameters, "interpolation", cheap) == [chosen]


def test_all_runs_of_cheap_models_are_refitted_where_nothing_was_searched() -> None:
    pool = [Run("lr", "paper"), PAPERS_RUN, Run("gp", "paper")]
    assert deployable_runs(pool, {}, "both") == pool
    assert runs_to_refit(pool, {}, "both", ["lr", "gb"]) == [PAPERS_RUN, Run("lr", "paper")]


def test_a_run_that_is_chosen_and_robust_gets_shells_once(best_parameters: dict[Run, Path]) -> None:
    outer = {Run(run.model, "outer"): file for run, file in best_parameters.items()}
    assert shell_runs([PAPERS_RUN, *outer], outer, "extrapolation", ["lr"]) == [PAPERS_RUN, Run("lr", "outer")]
