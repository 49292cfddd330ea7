"""Whether a configuration leaves an interval method that can be chosen for every dataset, known before it runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from softkin.core.narrowing import NARROWED, narrowed_configuration
from softkin.core.runs import PAPER, SEARCHED, TUNED
from softkin.models.spec import PointModel
from softkin.uncertainty.calibration_data import PredictiveCalibration
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod


def problems_of_methods(
    config: Mapping[str, Any], methods: Mapping[str, IntervalMethod[Any]], models: Mapping[str, PointModel]
) -> Iterator[str]:
    """Why no calibrated model could be made of the configured `interval_methods`, and methods that have no data;
    where there are none, the same of each dataset whose entry narrows what it gets.
    """
    problems = list(_problems("interval_methods", config, methods, models))
    for dataset in config["datasets"] if not problems else ():
        own = narrowed_configuration(config, dataset)
        if set(NARROWED) & set(config["sources"][dataset]) and all(own[key] for key in NARROWED):
            problems += _problems(f"sources.{dataset}.interval_methods", own, methods, models)
    yield from problems


def _problems(
    key: str, config: Mapping[str, Any], methods: Mapping[str, IntervalMethod[Any]], models: Mapping[str, PointModel]
) -> Iterator[str]:
    """Those of one configuration, at the `key` of its methods."""
    configured = [methods[name] for name in config["interval_methods"]]
    is_searched = bool(set(SEARCHED) & set(config["presets"]))
    ensembles = config["ensembles"] if is_searched else []
    pool = [models[name] for name in [*config["models"], *ensembles]]
    usable = [method for method in configured if is_searched or not method.calibrated_on.needs_held_out]
    if not any(_can_be_deployed(method, pool) for method in usable):
        yield (
            f"{key}: of {', '.join(config['interval_methods'])} none is calibrated around every model, so "
            "no calibrated model can be made; add scp_mapie"
        )
    quantile_methods = [method.name for method in configured if method.calibrated_on.needs_quantiles]
    if quantile_methods and not {PAPER, TUNED} & set(config["presets"]):
        yield (
            f"{key}: {', '.join(quantile_methods)} need quantile regressors, which have no preset "
            f"{', '.join(config['presets'])}; add paper or tuned to presets, or leave them out"
        )


def _can_be_deployed(method: IntervalMethod[Any], pool: list[PointModel]) -> bool:
    """Whether a calibrated model can hold the method, whichever model of the pool is deployed."""
    kind = method.calibrated_on
    if method.guarantee != MARGINAL or kind.is_for_extrapolation or not kind.is_around_a_model:
        return False
    if not kind.has_spread:
        return True
    needs_distribution = issubclass(kind, PredictiveCalibration)
    return all(spec.spread is not None and (spec.is_predictive or not needs_distribution) for spec in pool)
