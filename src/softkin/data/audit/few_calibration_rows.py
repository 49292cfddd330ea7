"""Check for a calibration set so small that no interval can have the usual confidence levels."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from softkin.core.samples import ROWS_FOR_95_PERCENT, VALIDATION, Samples
from softkin.data.audit.findings import WARNING, CheckResult, Finding, counted

#: Confidence levels that people ask for.
USUAL_LEVELS = (0.8, 0.9, 0.95, 0.99)


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding, on `validation`: of n rows no finite interval has a level above n / (n + 1).

    Source: Vovk, Gammerman and Shafer (2005); Lei et al. (2018), section 2.2.
    """
    n_rows = len(samples[VALIDATION])
    numbers = {"calibration_rows": n_rows, "highest_level": n_rows / (n_rows + 1)}
    if n_rows >= ROWS_FOR_95_PERCENT:
        return CheckResult((), numbers)
    lost = [level for level in USUAL_LEVELS if Fraction(str(level)) * (n_rows + 1) > n_rows]
    finding = Finding(
        "few_calibration_rows",
        WARNING,
        (VALIDATION,),
        f"Validation has {counted(n_rows, 'row')}, so {_listed(lost)} cannot be had: no finite interval is calibrated "
        f"above {100 * numbers['highest_level']:.1f} %.",
        "Calibrated intervals at such levels are infinite and say nothing, methods cannot be told apart by them, and "
        f"coverage on so few rows is chance. From {ROWS_FOR_95_PERCENT} rows on 95 % can be had.",
    )
    return CheckResult((finding,), numbers)


def _listed(levels: list[float]) -> str:
    texts = [f"{100 * level:g} %" for level in levels]
    return f"the confidence level {texts[0]}" if len(texts) == 1 else f"the confidence levels {', '.join(texts)}"
