"""Faults of notifications."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

FAULTS = [
    Fault(
        "a notification fails",
        "said; the exit code is that of the campaign",
        "unit/cli/test_notification.py::test_every_url_gets_the_verdict_and_one_that_fails_is_said",
    ),
    Fault(
        "the command that is told hangs",
        "it is ended after a minute, and that is said; the next night starts",
        "unit/cli/test_notification.py::test_a_command_that_hangs_is_ended_with_its_children",
    ),
    Fault(
        "there are URLs, and Apprise is not installed",
        "one message before anything is computed",
        "unit/cli/test_notification.py::test_urls_without_apprise_are_an_error_that_shows_none",
    ),
]
