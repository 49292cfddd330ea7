"""Numbers as text: one format for every table, the headline and the page."""

from __future__ import annotations

import math

from softkin.core.units import MM

#: Stands where there is no number.
NOTHING = "–"
#: Stands where there are too few distinct commands to tell a coverage.
NOT_ASSESSABLE = "not assessable"
#: A number below this is given as a bound.
SMALLEST = 1e-9
#: mm.
NANOMETRE = 1e-6


def number_text(value: float | None) -> str:
    """Three significant digits, never with an exponent: '2.89', '0.000538', '115', '<0.000000001', 'infinite'.

    A number that is not there, or NaN, is a dash.
    """
    if value is None or math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "infinite" if value > 0 else "-infinite"
    if value == 0:
        return "0"
    if abs(value) < SMALLEST:
        return f"{'<' if value > 0 else '>-'}{SMALLEST:.9f}"
    decimals = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def share_text(value: float | None, decimals: int = 1) -> str:
    """A share in percent: '91.4 %'."""
    return NOTHING if value is None or math.isnan(value) else f"{100 * value:.{decimals}f} %"


def assessed_text(coverage: float, assessable: bool) -> str:
    """A coverage in percent, or that there are too few distinct commands to tell one."""
    return share_text(coverage) if assessable else NOT_ASSESSABLE


def band_text(low: float, high: float) -> str:
    """The ends of a band: '1.31 to 1.44'."""
    return NOTHING if math.isnan(low) or math.isnan(high) else f"{number_text(low)} to {number_text(high)}"


def length_text(value: float, unit: str = MM) -> str:
    """A length outside a table: '0.509 mm', 'below a nanometre', '3.2 px'."""
    if unit == MM and 0 <= value < NANOMETRE:
        return "below a nanometre"
    return f"{number_text(value)} {unit}"
