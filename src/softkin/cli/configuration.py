"""Check all that can be known of a configuration before any job starts: files, schema, names, entries, addresses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from softkin.core.addresses import problems_of_mirror, problems_of_store
from softkin.core.config_files import check_config_files
from softkin.core.configuration import Check, check_configuration
from softkin.data.entries import problems_of_entries
from softkin.data.readers import READERS
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.known_params import problems_of_paper_params
from softkin.models.quantile import QUANTILE_MODELS
from softkin.uncertainty.candidates import problems_of_methods
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.regions import REGION_METHODS

#: Registries whose names a configuration may hold, by the name that `check_configuration` knows them by.
REGISTRIES: dict[str, Mapping[str, Any]] = {
    "models": MODELS,
    "ensembles": ENSEMBLES,
    "formats": READERS,
    "interval_methods": INTERVAL_METHODS,
    "quantile_models": QUANTILE_MODELS,
    "regions": REGION_METHODS,
    "standins": STANDINS,
}
#: Variables that go before the configuration -> what finds the problems of their values.
VARIABLES = {"MLFLOW_TRACKING_URI": problems_of_store, "SOFTKIN_DATA_MIRROR": problems_of_mirror}


def check(
    config: Mapping[str, Any], *, schema: str | Path, files: Sequence[str | Path], environment: Mapping[str, str]
) -> None:
    """Check the configuration that Snakemake has merged from `files`, as far as it can be known before any job starts.

    Parameters:
        config: the merged configuration.
        schema: path of workflow/schemas/config.schema.yaml.
        files: the configuration's files, for keys that stand twice and for messages.
        environment: variables of the process.

    Raises:
        ConfigError: a file says two things, or the configuration cannot be used; lists every problem.
    """
    check_config_files(files)
    checks: list[Check] = [
        problems_of_entries,
        partial(problems_of_methods, methods=INTERVAL_METHODS, models={**MODELS, **ENSEMBLES}),
        partial(problems_of_paper_params, models=MODELS),
        partial(_problems_of_environment, environment),
        _problems_of_results,
    ]
    check_configuration(config, schema, REGISTRIES, checks, [_shown(path) for path in files])


def _problems_of_environment(environment: Mapping[str, str], _config: Mapping[str, Any]) -> Iterator[str]:
    for name, problems in VARIABLES.items():
        if environment.get(name):
            yield from problems(environment[name], f"variable {name}")


def _problems_of_results(_config: Mapping[str, Any]) -> Iterable[str]:
    is_in_the_way = Path("results").exists() and not Path("results").is_dir()
    return ["results: a file of that name is in the way of the folder; move it away"] if is_in_the_way else []


def _shown(path: str | Path) -> Path:
    """A path as a person knows it: from the working directory, where it lies below."""
    full = Path(path)
    return full.relative_to(Path.cwd()) if full.is_relative_to(Path.cwd()) else full
