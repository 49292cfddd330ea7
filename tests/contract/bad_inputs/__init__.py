"""Bad inputs as data: what is wrong, how to make it, what the message must say. `test_bad_inputs.py` tries each, and
`tools/bad_inputs_page.py` writes docs/bad_inputs.md from what softkin answered.
"""

from __future__ import annotations

from tests.contract.bad_inputs import (
    addresses,
    config_files,
    config_values,
    entries,
    new_robots,
    published_files,
    results,
    tables,
)
from tests.contract.bad_inputs.case import BadInput

#: Heading -> its cases, in the order of the page.
CASES: dict[str, list[BadInput]] = {
    "Files of the configuration": config_files.CASES,
    "Values in the configuration": config_values.CASES,
    "Addresses": addresses.CASES,
    "Entries of datasets": entries.CASES,
    "Published files (JSON)": published_files.CASES,
    "Tables of one's own (CSV, Parquet)": tables.CASES,
    "New robots": new_robots.CASES,
    "Results that are damaged, and what a machine refuses": results.CASES,
}
