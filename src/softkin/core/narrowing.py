"""What one dataset gets of the models, presets and methods that are configured: all, or what its entry narrows them to.

An entry of config/datasets.yaml may have keys of the same names as the configuration's: of the names in such a key of
the configuration, the dataset gets those that its entry names, too, in the order of the configuration.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from softkin.core.runs import SEARCHED

#: The keys that an entry may narrow, and what they name.
NARROWED = {
    "models": "models",
    "presets": "presets",
    "quantile_models": "quantile regressors",
    "interval_methods": "interval methods",
}
#: Those of them that decide which files a job makes of a dataset.
OF_FILES = ("presets", "interval_methods")


@dataclass(frozen=True, slots=True)
class Group:
    """Datasets of which the same `presets` and `interval_methods` are made, and so files of the same names.

    `name` is that of the first of them; empty for all those whose entries narrow neither.
    """

    name: str
    datasets: tuple[str, ...]
    presets: list[str]
    interval_methods: list[str]


def narrowed(config: Mapping[str, Any], key: str, dataset: str) -> list[str]:
    """The names that a dataset gets of a `key` of the configuration, in its order."""
    names: list[str] = config[key]
    own = config["sources"].get(dataset, {}).get(key) if key in NARROWED else None
    return names if own is None else [name for name in names if name in own]


def narrowed_configuration(config: Mapping[str, Any], dataset: str) -> dict[str, Any]:
    """The configuration as one dataset gets it."""
    return {**config, **{key: narrowed(config, key, dataset) for key in NARROWED if key in config}}


def of_data(entry: Mapping[str, Any]) -> dict[str, Any]:
    """What an entry says of its data: the same whatever is fitted to them."""
    return {key: value for key, value in entry.items() if key not in NARROWED}


def groups(config: Mapping[str, Any]) -> list[Group]:
    """The configured datasets, those together that get the same files; first those whose entries narrow none of these,
    also where there are none such.
    """
    everything = tuple(tuple(config[key]) for key in OF_FILES)
    found: dict[tuple[tuple[str, ...], ...], list[str]] = {everything: []}
    for dataset in config["datasets"]:
        found.setdefault(tuple(tuple(narrowed(config, key, dataset)) for key in OF_FILES), []).append(dataset)
    return [
        Group("" if key == everything else datasets[0], tuple(datasets), *map(list, key))
        for key, datasets in found.items()
    ]


def name_of(rule: str, group: Group) -> str:
    """What a `rule` of the workflow that is made for each group is called in one: in that of most datasets as it is."""
    return f"{rule}_{group.name}" if group.name else rule


def problems_of_narrowing(config: Mapping[str, Any]) -> Iterator[str]:
    """A line for each list in the entry of a configured dataset of which the configuration names nothing, and for each
    that leaves out presets which tables across datasets need.
    """
    for dataset in config["datasets"]:
        entry = config["sources"][dataset]
        for key, what in NARROWED.items():
            if key in entry and not narrowed(config, key, dataset):
                yield (
                    f"sources.{dataset}.{key}: of {', '.join(entry[key])} none is among the configured {what} "
                    f"({', '.join(config[key])}); add one of them to {key}, or take {dataset} out of datasets"
                )
        presets = narrowed(config, "presets", dataset)
        if not presets or presets == config["presets"]:
            continue
        if "paper_table" in entry:
            yield f"sources.{dataset}.presets: the paper's table is compared with every preset; leave it out"
        if set(SEARCHED) & set(config["presets"]) and not set(SEARCHED) & set(presets):
            yield (
                f"sources.{dataset}.presets: {', '.join(presets)} is not searched for, and models are chosen by the "
                f"scores of searches; add {' or '.join(SEARCHED)}"
            )
