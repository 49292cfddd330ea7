"""Faults that softkin survives: what happens, and the test that shows it. docs/faults.md is made from these tables."""

from __future__ import annotations

from tests.contract.faults import downloads, failed_jobs, killed_runs, machine, notifications, results, store, studies
from tests.contract.faults.fault import Fault

#: Heading -> faults.
FAULTS: dict[str, list[Fault]] = {
    "Runs that are killed": killed_runs.FAULTS,
    "Jobs that fail": failed_jobs.FAULTS,
    "Studies": studies.FAULTS,
    "Results": results.FAULTS,
    "The machine": machine.FAULTS,
    "The MLflow store": store.FAULTS,
    "Downloads": downloads.FAULTS,
    "Telling somebody": notifications.FAULTS,
}
