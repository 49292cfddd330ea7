"""What rules of claims share: cases of one preset at a time, ranks, categories, and how numbers are written."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from statistics import fmean, median

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.models.paper_groups import ALL
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case
from softkin.reporting.tables.numbers import number_text

#: Errors that differ by less than this factor are of a size, by more than the other one far apart.
OF_A_SIZE, FAR_APART = 1.5, 2.0
#: Errors (mm) by model -> whether the claim holds there, and the number that says so.
Compare = Callable[[dict[str, float]], tuple[bool, str]]

POINTS = "point_metrics.csv"
SECTION = "section 4, system identification"
MISSING_MODELS = "the paper's eight models on complete published robots"


def of_errors(
    measured: Measured,
    compare: Compare,
    *,
    models: Iterable[str] = ALL,
    subsets: Sequence[str] = (TEST, EXTRAPOLATION),
    datasets: Iterable[str] | None = None,
) -> Iterator[Case]:
    """A case per preset and place: what `compare` says of the RMSE of the models there."""
    for preset in measured.presets:
        for place in measured.places(subsets):
            errors = measured.errors(place, preset, models)
            if errors and (datasets is None or place[0] in datasets):
                holds, number = compare(errors)
                yield Case(preset, " ".join(place), holds, number)


def of_growth(measured: Measured, compare: Compare, *, models: Iterable[str] = ALL) -> Iterator[Case]:
    """A case per preset and dataset: what `compare` says of the ratios of RMSE in extrapolation to RMSE on test."""
    models = tuple(models)
    for preset in measured.presets:
        for dataset in measured.robots():
            places = [(dataset, subset) for subset in (TEST, EXTRAPOLATION)]
            if not set(places) <= set(measured.places()):
                continue
            before, after = (measured.errors(place, preset, models) for place in places)
            if before and after and min(before.values()) > 0:
                holds, number = compare({model: after[model] / before[model] for model in models})
                yield Case(preset, dataset, holds, number)


def best(errors: dict[str, float]) -> str:
    """The model of the smallest error."""
    return min(errors, key=errors.__getitem__)


def least(errors: dict[str, float], models: Iterable[str]) -> float:
    """The smallest error of some models."""
    return min(errors[model] for model in models)


def middle(errors: dict[str, float], models: Iterable[str]) -> float:
    """The median error of some models."""
    return median(errors[model] for model in models)


def ranks(errors: dict[str, float]) -> dict[str, float]:
    """Rank of each model by its error, 1 the best; of equal errors the mean rank."""
    ordered = sorted(errors.values())
    return {
        model: fmean(place for place, other in enumerate(ordered, 1) if other == error)
        for model, error in errors.items()
    }


def against(one: str, value: float, other: str, reference: float) -> str:
    """'gb 1.59, svr 1.40'."""
    return f"{one} {number_text(value)}, {other} {number_text(reference)}"
