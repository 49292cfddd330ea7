from __future__ import annotations

from typing import Any

from softkin.core.narrowing import (
    Group,
    groups,
    name_of,
    narrowed,
    narrowed_configuration,
    of_data,
    problems_of_narrowing,
)

CONFIG: dict[str, Any] = {
    "datasets": ["arm", "finger", "trunk", "leg"],
    "models": ["lr", "gp", "mlp"],
    "presets": ["paper", "tuned", "outer"],
    "quantile_models": ["gb"],
    "interval_methods": ["qr", "scp_mapie", "auto"],
    "regions": ["joint_box"],
    "sources": {
        "arm": {"title": "ARM"},
        "finger": {"models": ["mlp", "lr"], "presets": ["tuned"], "regions": []},
        "trunk": {"models": ["gp"]},
        "leg": {"presets": ["tuned"], "interval_methods": ["auto", "scp_mapie", "qr"]},
        "not_run": {"models": ["rf"]},
    },
}


def test_a_dataset_gets_what_its_entry_names_in_the_order_of_the_configuration() -> None:
    assert narrowed(CONFIG, "models", "finger") == ["lr", "mlp"]
    assert narrowed(CONFIG, "models", "arm") is CONFIG["models"]
    assert narrowed(CONFIG, "models", "a_dataset_without_an_entry") is CONFIG["models"]
    assert narrowed(CONFIG, "regions", "finger") == ["joint_box"]
    own = narrowed_configuration(CONFIG, "finger")
    assert own == CONFIG | {"models": ["lr", "mlp"], "presets": ["tuned"]}


def test_what_an_entry_says_of_its_data_is_without_what_is_fitted_to_them() -> None:
    assert of_data({"title": "ARM", "models": ["lr"], "presets": [], "rows": {}}) == {"title": "ARM", "rows": {}}


def test_datasets_of_the_same_files_are_together_and_those_of_all_files_come_first() -> None:
    methods = CONFIG["interval_methods"]
    everything = Group("", ("arm", "trunk"), CONFIG["presets"], methods)
    assert groups(CONFIG) == [everything, Group("finger", ("finger", "leg"), ["tuned"], methods)]
    assert [name_of("refit", group) for group in groups(CONFIG)] == ["refit", "refit_finger"]
    assert groups(CONFIG | {"datasets": ["leg"]})[0] == Group("", (), CONFIG["presets"], methods)


def test_a_list_of_which_nothing_is_configured_is_told_of_configured_datasets() -> None:
    assert list(problems_of_narrowing(CONFIG)) == []
    (told,) = problems_of_narrowing(CONFIG | {"models": ["lr", "rf"]})
    assert told.startswith("sources.trunk.models: of gp none is among the configured models (lr, rf)")
    assert narrowed(CONFIG | {"models": ["lr", "rf"]}, "models", "finger") == ["lr"]


def test_presets_that_tables_across_datasets_need_are_told() -> None:
    sources = {"arm": {"presets": ["paper"]}, "finger": {"presets": ["outer"], "paper_table": 5}}
    config = CONFIG | {"datasets": ["arm", "finger"], "sources": sources}
    chosen, compared = problems_of_narrowing(config)
    assert chosen.startswith("sources.arm.presets: paper is not searched for")
    assert compared.startswith("sources.finger.presets: the paper's table is compared with every preset")
    assert list(problems_of_narrowing(config | {"datasets": ["arm"], "presets": ["paper"]})) == []
