"""How many rows of `train` a model or a quantile regressor is fitted on at most, by the configuration's
`max_fit_rows`.
"""

from __future__ import annotations

from collections.abc import Mapping

#: Before the name of a quantile regressor in `max_fit_rows`: a bound of its own, and not that of the model of its name.
OF_QUANTILES = "quantile_"


def rows_of_fit(max_fit_rows: Mapping[str, int], model: str | None, quantile_model: str | None) -> int | None:
    """Of the `model`, or where that is None of the quantile regressor: its own bound, or that of the model of its name;
    None for any number.
    """
    if model is not None:
        return max_fit_rows.get(model)
    return max_fit_rows.get(f"{OF_QUANTILES}{quantile_model}", max_fit_rows.get(str(quantile_model)))


def bounds_of(max_fit_rows: Mapping[str, int], models: list[str], quantile_models: list[str]) -> dict[str, int]:
    """Of these models and quantile regressors the rows that they are fitted on at most, by the keys of the
    configuration.
    """
    fitted = {*models, *quantile_models, *(f"{OF_QUANTILES}{name}" for name in quantile_models)}
    return {name: most for name, most in max_fit_rows.items() if name in fitted}
