"""Check the configuration against its schema and the registries, and list every problem with its likely fix."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator, TypeChecker
from jsonschema.exceptions import ValidationError
from jsonschema.validators import extend

from softkin.core.addresses import problems_of_mirror, problems_of_store
from softkin.core.errors import ConfigError
from softkin.core.fit_rows import OF_QUANTILES
from softkin.core.narrowing import problems_of_narrowing
from softkin.core.plain_values import problems_of_values
from softkin.core.schema_files import read_schema

#: Largest seed that numpy and scikit-learn take, less one.
MAX_SEED = 2**32 - 2
#: What a value is not, where jsonschema says 'is not of type ...'.
_TYPES = {"integer": "whole number", "number": "number", "string": "text", "array": "list", "object": "set of keys"}

#: Finds what is wrong with a configuration that its schema admits: a line for each problem.
Check = Callable[[Mapping[str, Any]], Iterable[str]]


def _is_whole(_checker: TypeChecker, value: Any) -> bool:
    """5 is a whole number; 5.0, which JSON Schema takes for one, is not, and counts nothing in Python."""
    return isinstance(value, int) and not isinstance(value, bool)


_Validator: Any = extend(  # type: ignore[no-untyped-call]
    Draft202012Validator, type_checker=Draft202012Validator.TYPE_CHECKER.redefine("integer", _is_whole)
)


def check_configuration(
    config: Mapping[str, Any],
    schema: str | Path,
    registries: Mapping[str, Iterable[str]],
    checks: Sequence[Check] = (),
    files: Sequence[str | Path] = (),
) -> None:
    """Check `config` against the YAML `schema`, the names in it against the `registries` (`models`, `ensembles`,
    `formats`, `interval_methods`, `regions`, `quantile_models` and `standins`), then by further `checks`. `files` are
    where it comes from, for the message.

    Raises:
        ConfigError: lists every problem: the key, what is wrong, and for an unknown name its likely spelling.
    """
    problems = list(problems_of_values(config))
    if not problems:
        validator = _Validator(read_schema(schema))
        problems = [line for error in validator.iter_errors(config) for line in _explain(error)]
    if not problems:
        problems = list(_unknown_names(config, registries))
    if not problems:
        found = [_problems_together(config), *(check(config) for check in checks)]
        problems = [line for lines in found for line in lines]
    if not problems:
        problems = list(problems_of_narrowing(config))
    if problems:
        raise ConfigError(
            "\n  ".join([f"{len(problems)} key{'s' * (len(problems) > 1)} cannot be used", *problems]),
            where=f"configuration ({', '.join(map(str, files))})" if files else "configuration",
            fix="correct each as config/README.md explains it",
        )


def _problems_together(config: Mapping[str, Any]) -> Iterator[str]:
    """Values that are possible each, and not together, and addresses that lead nowhere."""
    levels, tuning = config["confidence_levels"], config["tuning"]
    shown = [f"{100 * level:g}" for level in levels]
    if len(set(shown)) < len(shown):
        yield f"confidence_levels: {levels} cannot be told apart in percent; keep one of those that are nearly equal"
    trials = max(tuning[name] for name in ("n_trials", "n_outer_trials", "n_quantile_trials"))
    if config["seed"] + trials > MAX_SEED + 1:
        yield f"seed: {config['seed']} and {trials} trials, each with the next seed, go beyond {MAX_SEED}; lower it"
    kept = config.get("max_rows_per_subset")
    rows = min(tuning["max_rows"], kept or tuning["max_rows"])
    if tuning["n_folds"] > rows:
        yield f"tuning.n_folds: {tuning['n_folds']} folds of at most {rows} rows; lower it"
    refitted = min(config["refitting"]["max_train_rows"], kept or config["refitting"]["max_train_rows"])
    if config["refitting"]["n_folds"] > refitted:
        yield f"refitting.n_folds: {config['refitting']['n_folds']} folds of at most {refitted} rows; lower it"
    yield from problems_of_store(config["tracking_uri"])
    if config.get("data_mirror") is not None:
        yield from problems_of_mirror(config["data_mirror"])


def _unknown_names(config: Mapping[str, Any], registries: Mapping[str, Iterable[str]]) -> Iterator[str]:
    """Levels out of order, and names that no registry has."""
    levels = list(config["confidence_levels"])
    if levels != sorted(levels):
        yield f"confidence_levels: {levels} are not ascending; write {sorted(levels)}"
    for key, kind, name, known in _named(config, registries):
        if name not in known:
            yield f"{key}: '{name}' is no {kind} ({', '.join(known)}){_guess(name, list(known))}"


def _named(
    config: Mapping[str, Any], registries: Mapping[str, Iterable[str]]
) -> Iterator[tuple[str, str, str, Iterable[str]]]:
    """(key, kind of thing, name, known names) of each name in the configuration."""
    for key, kind, registry in (
        ("datasets", "entry of config/datasets.yaml", config["sources"]),
        ("models", "model", registries["models"]),
        ("ensembles", "ensemble", registries["ensembles"]),
        ("interval_methods", "interval method", registries["interval_methods"]),
        ("regions", "region", registries["regions"]),
        ("quantile_models", "quantile regressor", registries["quantile_models"]),
    ):
        yield from ((key, kind, name, registry) for name in config[key])
    for name in config["max_fit_rows"]:
        of_quantiles = name.removeprefix(OF_QUANTILES)
        if of_quantiles == name:
            yield "max_fit_rows", "model", name, registries["models"]
        else:
            yield "max_fit_rows", "quantile regressor", of_quantiles, registries["quantile_models"]
    for dataset, source in config["sources"].items():
        key = f"sources.{dataset}"
        yield f"{key}.format", "format", source["format"], registries["formats"]
        if "standin" in source:
            yield f"{key}.standin.robot", "simulated robot", source["standin"]["robot"], registries["standins"]
        for own, kind in (
            ("models", "model"),
            ("quantile_models", "quantile regressor"),
            ("interval_methods", "interval method"),
        ):
            yield from ((f"{key}.{own}", kind, name, registries[own]) for name in source.get(own, ()))
        for model in source.get("paper_params", {}):
            yield f"{key}.paper_params", "model", model, registries["models"]


def _explain(error: ValidationError) -> list[str]:
    """One line per problem of a violation of the schema."""
    place = ".".join(map(str, error.absolute_path)) or "top level"
    schema: Any = error.schema
    value: Any = error.validator_value
    instance: Any = error.instance
    if error.validator == "additionalProperties":
        known = list(schema.get("properties", {}))
        unknown = [key for key in instance if key not in known]
        return [f"{place}: unknown key '{key[:60]}'{_guess(key, known)}" for key in unknown]
    if error.validator == "enum":
        choices = [str(choice) for choice in value]
        return [f"{place}: {_short(instance)} is none of {', '.join(choices)}{_guess(str(instance), choices)}"]
    if error.validator == "required":
        return [f"{place}: {error.message}"]
    message = error.message.replace(repr(instance), _short(instance), 1)
    if error.validator == "type":
        kinds = [_TYPES[kind] for kind in ([value] if isinstance(value, str) else value) if kind != "null"]
        message = f"{_short(instance)} is no {' or '.join(kinds)}"
        if "integer" in value and isinstance(instance, float) and instance.is_integer():
            message += f"; write {int(instance)}"
    if error.validator == "pattern":
        message = f"{_short(instance)} is not what can stand here"
    description = schema.get("description", "")
    return [f"{place}: {message}" + (f" ({description})" if description else "")]


def _short(value: Any) -> str:
    """A value as it is shown in a message."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _guess(word: str, known: list[str]) -> str:
    near = difflib.get_close_matches(word, known, n=1)
    return f"; did you mean '{near[0]}'?" if near else ""
