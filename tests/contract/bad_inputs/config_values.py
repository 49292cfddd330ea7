"""Values that no key may have, and values that are possible each and not together."""

from __future__ import annotations

from pathlib import Path

from tests.contract.bad_inputs.case import BadInput, check_with, configured

CALIBRATED = ("none is calibrated", "add scp_mapie")


def results_is_a_file() -> None:
    Path("results").write_text("")
    check_with({})


def of_itself() -> None:
    """YAML can do this, with an anchor around its own alias."""
    models: list[object] = ["lr"]
    models.append(models)
    check_with({"models": models})


CASES = [
    BadInput("an unknown key", configured("sed: 1"), ("unknown key 'sed'", "did you mean 'seed'?")),
    BadInput("an unknown key in a section", configured("tuning: {n_trails: 1}"), ("did you mean 'n_trials'?",)),
    BadInput("a key that is no text", configured("1: 2"), ("the key 1 is no text",)),
    BadInput("a section that is a number", configured("tuning: 3"), ("tuning: 3 is no set of keys",)),
    BadInput("a section emptied", configured("tuning:"), ("tuning: None is no set of keys",)),
    BadInput("a list that holds itself", of_itself, ("models: nested deeper",)),
    BadInput("a control character in text", configured('caution: "a\\u0007b"'), ("caution", "control character")),
    BadInput("a name with a line break", configured('campaign: "default\\n"'), ("campaign", "at most 60 letters")),
    BadInput("a campaign with a blank", configured("campaign: my run"), ("campaign", "letters, digits")),
    BadInput("an empty caution", configured("caution: ''"), ("caution",)),
    BadInput("a seed that is 5.0", configured("seed: 5.0"), ("seed: 5.0 is no whole number", "write 5")),
    BadInput("a seed in quotes", configured("seed: '5'"), ("seed: '5' is no whole number",)),
    BadInput("a seed that is true", configured("seed: true"), ("seed: True is no whole number",)),
    BadInput("a negative seed", configured("seed: -1"), ("seed: -1",)),
    BadInput("a seed of 2^32 - 1", configured("seed: 4294967295"), ("seed: 4294967295", "4294967294")),
    BadInput("a seed that trials carry too far", configured("seed: 4294967290"), ("seed", "25 trials", "lower it")),
    BadInput("a seed of 400 bits", configured(f"seed: {2**400}"), ("seed: a whole number beyond",)),
    BadInput("a seed that is NaN", configured("seed: .nan"), ("seed: nan is no finite number",)),
    BadInput("a number in exponents", configured("tuning: {max_rows: 1e3}"), ("'1e3' is no whole number",)),
    BadInput("no levels", configured("confidence_levels: []"), ("confidence_levels: []",)),
    BadInput("a level of 0", configured("confidence_levels: [0]"), ("confidence_levels.0: 0",)),
    BadInput("a level of 1", configured("confidence_levels: [0.9, 1]"), ("confidence_levels.1: 1",)),
    BadInput("a level in percent", configured("confidence_levels: [90]"), ("confidence_levels.0: 90", "0.9 for 90")),
    BadInput("a level that is NaN", configured("confidence_levels: [.nan]"), ("confidence_levels.0: nan",)),
    BadInput("a level that is infinite", configured("confidence_levels: [.inf]"), ("confidence_levels.0: inf",)),
    BadInput("a level that rounds to 1", configured("confidence_levels: [0.99999999999]"), ("0.01 to 0.9999",)),
    BadInput("a level twice", configured("confidence_levels: [0.9, 0.90]"), ("confidence_levels",)),
    BadInput("levels nearly equal", configured("confidence_levels: [0.9, 0.900000001]"), ("cannot be told apart",)),
    BadInput("levels out of order", configured("confidence_levels: [0.9, 0.8]"), ("not ascending", "[0.8, 0.9]")),
    BadInput("a level in quotes", configured("confidence_levels: ['0.9']"), ("'0.9' is no number",)),
    BadInput("no models", configured("models: []"), ("models: []",)),
    BadInput("a model twice", configured("models: [lr, lr]"), ("models", "non-unique")),
    BadInput("a model without brackets", configured("models: lr"), ("models: 'lr' is no list",)),
    BadInput("an unknown model", configured("models: [svm]"), ("'svm' is no model", "did you mean 'svr'?")),
    BadInput("no presets", configured("presets: []"), ("presets: []",)),
    BadInput("an unknown preset", configured("presets: [tunde]"), ("presets.0", "did you mean 'tuned'?")),
    BadInput("an unknown target space", configured("target_spaces: [curved]"), ("target_spaces.0: 'curved'",)),
    BadInput("an unknown objective", configured("objective: interpolate"), ("did you mean 'interpolation'?",)),
    BadInput("an unknown regime", configured("regime: automatic"), ("regime: 'automatic'",)),
    BadInput("an unknown region", configured("regions: [joint_boxes]"), ("did you mean 'joint_box'?",)),
    BadInput("an unknown quantile model", configured("quantile_models: [xbg]"), ("did you mean 'xgb'?",)),
    BadInput("no quantile models", configured("quantile_models: []"), ("quantile_models: []",)),
    BadInput("an unknown interval method", configured("interval_methods: [scp]"), ("'scp' is no interval method",)),
    BadInput("no interval methods", configured("interval_methods: []"), ("interval_methods: []",)),
    BadInput("no method that is calibrated", configured("interval_methods: [gaussian]"), CALIBRATED),
    BadInput("quantile methods alone", configured("interval_methods: [qr, cqr]"), CALIBRATED),
    BadInput("methods for extrapolation alone", configured("interval_methods: [shell, auto]"), CALIBRATED),
    BadInput("methods of refits alone", configured("interval_methods: [cv_plus, jackknife_plus_ab]"), CALIBRATED),
    BadInput("a method that some models cannot have", configured("interval_methods: [scp_spread]"), CALIBRATED),
    BadInput(
        "quantiles without their presets",
        configured("presets: [outer]"),
        ("qr, cqr need quantile", "add paper or tuned"),
    ),
    BadInput("no trials", configured("tuning: {n_trials: 0}"), ("tuning.n_trials: 0",)),
    BadInput("negative trials", configured("tuning: {n_outer_trials: -5}"), ("tuning.n_outer_trials: -5",)),
    BadInput("a million trials", configured("tuning: {n_trials: 1000000}"), ("tuning.n_trials: 1000000",)),
    BadInput("trials that are infinite", configured("tuning: {n_trials: .inf}"), ("inf is no finite number",)),
    BadInput("one fold", configured("tuning: {n_folds: 1}"), ("tuning.n_folds: 1", "at least 2")),
    BadInput("more folds than rows", configured("tuning: {n_folds: 90, max_rows: 80}"), ("90 folds", "80 rows")),
    BadInput("no rows of a trial", configured("tuning: {max_rows: 0}"), ("tuning.max_rows: 0",)),
    BadInput("no markers of a trial", configured("tuning: {max_markers: 0}"), ("tuning.max_markers: 0",)),
    BadInput("a core of all rows", configured("tuning: {core_shares: [1.0]}"), ("tuning.core_shares.0: 1.0",)),
    BadInput("no cores", configured("shells: {core_shares: []}"), ("shells.core_shares: []",)),
    BadInput("no rows of a core", configured("shells: {max_rows: 0}"), ("shells.max_rows: 0",)),
    BadInput("too few bootstrap samples", configured("refitting: {n_resamples: 3}"), ("at least 10",)),
    BadInput("no rows of a subset", configured("max_rows_per_subset: 0"), ("max_rows_per_subset: 0",)),
    BadInput("rows of a model that are no model's", configured("max_fit_rows: {gpp: 200}"), ("did you mean 'gp'?",)),
    BadInput("few rows of a model", configured("max_fit_rows: {gp: 5}"), ("max_fit_rows.gp: 5",)),
    BadInput("what is neither of two", configured("when_unreachable: simulat"), ("did you mean 'simulate'?",)),
    BadInput("a file named results", results_is_a_file, ("results", "in the way of the folder")),
]
