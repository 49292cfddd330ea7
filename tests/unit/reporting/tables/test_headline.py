from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.headline import headline


def scores(mean: float, p95: float) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {"dataset": "arm", "model": "gp", "preset": "tuned", "subset": subset}
            | {"euclidean_mean_mm": mean * factor, "euclidean_p95_mm": p95 * factor}
            for subset, factor in (("test", 1.0), ("extrapolation", 3.0))
        ]
    )


CHOICE = pd.DataFrame(
    [
        {"dataset": "arm", "model": "gp", "preset": "tuned", "interval_method": method, "confidence_level": 0.9}
        | {
            "test_mean_width_mm": width,
            "test_coverage": 0.912,
            "extrapolation_coverage": 0.95,
            "extrapolation_commands": 40,
            "extrapolation_assessable": True,
            "chosen": method == "cqr",
            "deployed": method == "scp_spread",
            "outside": "auto" if method == "scp_spread" else method,
        }
        for method, width in (("cqr", 7.0), ("scp_spread", 2.5))
    ]
)
SELECTED = pd.DataFrame([{"dataset": "arm", "model": "gp", "preset": "tuned", "objective": "both"}])


def test_the_deployed_model_and_its_errors() -> None:
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, ["tuned preset: 3 of 4"])
    assert "arm gp tuned 0.500 1.25 1.50" in " ".join(text.split())
    assert "tuned preset: 3 of 4" in text
    assert "chosen for commands like those of train and beyond, on `train` alone" in text
    assert "gross errors" not in text
    assert max(map(len, text.splitlines())) <= 90


def test_a_caution_stands_before_all_numbers() -> None:
    caution = "These are the numbers of a demonstration: one robot, few models, few trials. For better ones: make run."
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, [], caution=caution)
    assert f"CAUTION: {caution}" in " ".join(text.split())
    assert text.index("CAUTION") < text.index("0.500")
    assert max(map(len, text.splitlines())) <= 90
    assert "CAUTION" not in headline(SELECTED, scores(0.5, 1.25), CHOICE, [])


def test_a_mean_set_by_a_few_rows_is_remarked_upon() -> None:
    assert "arm: a few gross errors set the mean" in headline(SELECTED, scores(2.0, 1.25), CHOICE, [])


def test_a_mean_that_hangs_on_one_row_is_marked() -> None:
    row = {"dataset": "arm", "subset": "test", "left_out": "row 3", "model": "gp", "preset": "tuned"}
    row |= {"interval_method": "", "metric": "euclidean_mean_mm"}
    left_out = pd.DataFrame([row | {"value": 0.5, "without": 0.02}])
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, [], left_out=left_out)
    assert "arm gp tuned 0.500* 1.25 1.50" in " ".join(text.split())
    assert "* arm, test: without row 3 it is 0.0200." in text
    assert "*" not in headline(SELECTED, scores(0.5, 1.25), CHOICE, [], left_out=left_out.assign(without=0.49))


def test_without_tuning_there_is_no_choice_to_show() -> None:
    text = headline(None, scores(1.0, 2.0), CHOICE, [])
    assert "The model is chosen" not in text


def test_the_interval_of_the_calibrated_model_and_its_coverage() -> None:
    text = " ".join(headline(SELECTED, scores(0.5, 1.25), CHOICE, []).split())
    assert "90 % intervals of the calibrated models" in text
    assert "arm gp tuned scp_spread 2.50 91.2 % 95.0 %" in text
    text = " ".join(headline(SELECTED, scores(0.5, 1.25), CHOICE.assign(deployed=False), []).split())
    assert "arm gp tuned cqr 7.00 91.2 % 95.0 %" in text


def test_too_few_distinct_commands_are_not_assessable() -> None:
    few = CHOICE.assign(extrapolation_commands=12, extrapolation_assessable=False)
    text = headline(SELECTED, scores(0.5, 1.25), few, [])
    assert max(map(len, text.splitlines())) <= 90
    text = " ".join(text.split())
    assert "arm gp tuned scp_spread 2.50 91.2 % not assessable" in text
    assert "arm: extrapolation has 12 distinct commands, and 29 are the fewest that can tell a coverage of 90 %" in text
    assert "not assessable" not in headline(SELECTED, scores(0.5, 1.25), CHOICE, [])


def test_a_chosen_method_that_is_not_deployed_is_named() -> None:
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, [])
    assert "arm: chosen is cqr (gp tuned), which surrounds no point model." in text
    same = CHOICE.assign(chosen=CHOICE["deployed"])
    assert "chosen is" not in headline(SELECTED, scores(0.5, 1.25), same, [])


def test_a_leak_is_named_as_the_audit_found_it() -> None:
    """It may be of `validation`, and other findings are none."""
    leak = {"severity": "leak", "sentence": "9 of 60 rows of validation have a command that stands exactly in train."}
    warning = {"severity": "warning", "sentence": "3 of 21 coordinates never move " + "and so on " * 20}
    note = {"severity": "note", "sentence": "A trifle."}
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, [], {"arm": [note, warning, leak], "other": []})
    assert text.index("arm: LEAK. 9 of 60 rows of validation") < text.index("arm: warning. 3 of 21 coordinates")
    assert "rows of test" not in text
    assert "arm: 1 more finding in its data card." in text
    assert "other:" not in text
    assert max(map(len, text.splitlines())) <= 90
    many = headline(SELECTED, scores(0.5, 1.25), CHOICE, [], {"arm": [warning] * 9})
    assert many.count("arm: warning.") == 4
    assert "arm: 5 more findings in its data card." in many
    assert "arm: 2 findings in its data card." in headline(SELECTED, scores(0.5, 1.25), CHOICE, [], {"arm": [note] * 2})
    none: list[dict[str, list[dict[str, str]]] | None] = [{}, {"arm": []}, None]
    for nothing in none:
        assert "audit" not in headline(SELECTED, scores(0.5, 1.25), CHOICE, [], nothing)


def test_it_claims_what_was_done() -> None:
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, [])
    assert "best around that model, chosen and calibrated on `validation`" in text
    assert "nothing is guaranteed; outer shells of `train` widen intervals.\n" in text
    without = headline(SELECTED, scores(0.5, 1.25), CHOICE.assign(outside=CHOICE["interval_method"]), [])
    assert "In extrapolation nothing is guaranteed.\n" in without
    assert "shells" not in without
    alone = headline(SELECTED, scores(0.5, 1.25), CHOICE[CHOICE["deployed"]].assign(chosen=True), [])
    assert "The method is calibrated on `validation`." in alone
    assert "best" not in alone
    none = headline(SELECTED, scores(0.5, 1.25), CHOICE.assign(deployed=False), [])
    assert "best" not in none


def test_shells_widen_the_intervals_of_some() -> None:
    other = CHOICE.assign(dataset="other", outside=CHOICE["interval_method"])
    both = pd.concat([SELECTED, SELECTED.assign(dataset="other")])
    point = pd.concat([scores(0.5, 1.25), scores(0.5, 1.25).assign(dataset="other")])
    text = headline(both, point, pd.concat([CHOICE, other]), [])
    assert "outer shells of `train` widen intervals of arm." in " ".join(text.split())


def test_tiny_errors_keep_the_columns_apart() -> None:
    lines = headline(SELECTED, scores(5.38e-7, 9.74e-7), CHOICE, []).splitlines()
    (line,) = [line for line in lines if line.startswith("  arm") and "0.000000538" in line]
    assert line.split()[1:] == ["gp", "tuned", "0.000000538", "0.000000974", "0.00000161"]
    assert max(map(len, lines)) <= 90


def test_whole_poses_have_lines_of_their_own() -> None:
    rows = [
        {"dataset": "arm", "model": "gp", "preset": "tuned", "interval_method": method, "subset": subset}
        | {"confidence_level": 0.9, "coordinate": "joint", "coverage": coverage, "size_mm": 3.0, "shape": "ellipsoids"}
        for method, subset, coverage in (
            *(("joint_intervals", "test", 0.912), ("joint_intervals", "extrapolation", 0.83)),
            *(("scp_spread", "test", 0.62), ("auto", "extrapolation", 0.7)),
        )
    ]
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE, [], metrics=pd.DataFrame(rows))
    assert "arm ellipsoids 3.00 91.2 % 83.0 %" in " ".join(text.split())
    assert "Intervals of single coordinates hold a whole pose of test in 62 % of cases." in text
    assert max(map(len, text.splitlines())) <= 90
    assert "whole poses" not in headline(SELECTED, scores(0.5, 1.25), CHOICE, [], metrics=pd.DataFrame(rows[2:]))


def test_lengths_are_in_the_robots_own_unit() -> None:
    text = headline(SELECTED, scores(0.5, 1.25), CHOICE.assign(unit="px"), [])
    assert "mean error of a marker position (px)" in text
    assert "width (px)" in text
    assert "mm" not in text.replace("commands", "")
    both = pd.concat([CHOICE.assign(unit="px"), CHOICE.assign(dataset="arm_2", unit="mm")])
    text = headline(None, scores(0.5, 1.25), both, [])
    assert "mean error of a marker position (mm or px)" in text
    assert "arm: all lengths are in px." in text
    assert "width (" not in text
