"""Faults of downloads."""

from __future__ import annotations

from tests.contract.faults.fault import Fault

RETRIEVE = "unit/data/test_retrieve.py"
DOWNLOAD = "unit/data/test_download.py"

FAULTS = [
    Fault(
        "the connection is refused",
        "named, and the next source is tried",
        f"{RETRIEVE}::test_a_refused_connection_is_named",
    ),
    Fault("a server fails and recovers", "tried again", f"{RETRIEVE}::test_a_source_that_recovers_is_tried_again"),
    Fault("a byte now and then", "given up", f"{DOWNLOAD}::test_a_byte_now_and_then_is_no_progress"),
    Fault("a packed body is cut off", "no file", f"{DOWNLOAD}::test_a_packed_body_that_is_cut_off_is_no_file"),
    Fault("a wrong file comes", "the right one stays", f"{RETRIEVE}::test_a_wrong_file_does_not_replace_a_right_one"),
    Fault(
        "all sources are out of reach",
        "a stand-in with its reason, until they return",
        "workflow/test_stand_ins.py::test_a_stand_in_takes_the_place_of_unreachable_data_until_they_return",
    ),
]
