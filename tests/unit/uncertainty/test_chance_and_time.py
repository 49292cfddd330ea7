from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.errors import ConfigError, DataError
from softkin.uncertainty.chance_and_time import check_generator, check_seed, session_of


def test_what_is_right_passes() -> None:
    check_generator(None, "arm")
    check_generator(np.random.default_rng(0), "arm")
    check_seed(np.int64(3), "arm")
    assert session_of(np.int64(2), [1.0, 2.0], "arm") == 2.0


@pytest.mark.parametrize("seed", [-1, 1.5, "a", None, True])
def test_a_seed_is_a_whole_number(seed: Any) -> None:
    with pytest.raises(ConfigError, match="is no seed"):
        check_seed(seed, "arm")


def test_a_seed_is_no_generator() -> None:
    with pytest.raises(ConfigError, match="0 is no random generator"):
        check_generator(0, "arm")


@pytest.mark.parametrize("session", [3, "1", True, float("nan"), None, 1j])
def test_a_session_is_one_of_the_recording(session: Any) -> None:
    with pytest.raises(DataError, match=r"no session .* in its recording \(\[1, 2\]\)"):
        session_of(session, [1.0, 2.0], "arm")
