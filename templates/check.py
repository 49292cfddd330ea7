"""Check for lost poses: rows whose coordinates are all exactly 0."""
# To add a check of the audit: copy this file to src/softkin/data/audit/<name>.py, fill in what the comments name, and
# add to src/softkin/data/audit/__init__.py the import of the module and the line (the key is the module's name)
#     "my_check": my_check.check,
# Then run: pytest tests/contract/test_checks.py -k my_check

from __future__ import annotations

from collections.abc import Mapping

from softkin.core.samples import Samples
from softkin.data.audit.findings import WARNING, CheckResult, finding_of_rows


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """One finding over all subsets."""
    # A mask (n_rows,) of each subset's rows to be named. Positions are in mm; nothing may be modified. A finding about
    # columns or whole subsets is a `Finding` without rows.
    marked = {subset: (rows.positions == 0.0).all(axis=1) for subset, rows in samples.items()}
    # Plain numbers for the data card, found something or not: int, float, str, lists and dicts of them; no NaN.
    numbers = {"rows": {subset: int(mask.sum()) for subset, mask in marked.items()}}
    n_marked = sum(numbers["rows"].values())
    if not n_marked:
        return CheckResult((), numbers)
    finding = finding_of_rows(
        # A name for the finding, for programs.
        "lost_poses",
        # NOTE, WARNING (whoever fits must know) or LEAK (the scores of its subsets are training error).
        WARNING,
        marked,
        # One sentence with the numbers, and one that says what follows from it for a reader of the tables.
        f"{n_marked} rows have a pose whose coordinates are all exactly 0.",
        "The tracking system lost its markers there: these rows are no poses of the robot.",
    )
    return CheckResult((finding,), numbers)
