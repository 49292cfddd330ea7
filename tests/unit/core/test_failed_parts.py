from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.core.failed_parts import PARTS, failed_parts, of_part
from softkin.core.job import job


@pytest.mark.parametrize("key", PARTS)
def test_what_a_job_failed_on_is_read_off_its_log(key: str, tmp_path: Path) -> None:
    log = str(tmp_path / "logs" / "score" / "arm.log")
    with pytest.raises(SystemExit), job(log, "score arm"), of_part(key, "scp_mapie"):
        raise DataError("no rows", where="arm", fix="add rows")
    assert failed_parts(log) == [(key, "scp_mapie")]


def test_a_job_that_failed_elsewhere_or_wrote_no_log_says_nothing(tmp_path: Path) -> None:
    log = str(tmp_path / "logs" / "score" / "arm.log")
    assert failed_parts(log) == []
    with job(log, "score arm"), of_part("models", "gp"):
        pass
    assert failed_parts(log) == []
    with pytest.raises(ZeroDivisionError), job(log, "score arm"):
        1 / 0  # noqa: B018
    assert failed_parts(log) == []
