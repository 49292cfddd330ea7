from __future__ import annotations

from softkin.core.job_params import other_params, params_hashes

PARAMS = {"seed": 1, "tuning": {"n_folds": 2, "max_rows": 80}, "jobs": [["fit_model", "finger"]], "caution": None}


def test_neither_the_order_of_keys_nor_the_kind_of_a_sequence_counts() -> None:
    same = PARAMS | {"tuning": {"max_rows": 80, "n_folds": 2}, "jobs": [("fit_model", "finger")]}
    assert other_params(params_hashes(PARAMS), same) == []


def test_those_that_differ_came_or_went_are_named() -> None:
    recorded = params_hashes(PARAMS)
    assert other_params(recorded, PARAMS | {"seed": 2}) == ["seed"]
    assert other_params(recorded, PARAMS | {"seed": "1"}) == ["seed"]
    assert other_params(recorded, {"seed": 1, "jobs": [], "tuning": PARAMS["tuning"], "code": "ab"}) == [
        *("caution", "code", "jobs")
    ]
