from __future__ import annotations

import pytest
from sklearn.preprocessing import MinMaxScaler

from softkin.core.errors import ConfigError
from softkin.models.plain.describe_spaces import described_space


def test_a_space_without_a_describer_is_named() -> None:
    with pytest.raises(ConfigError, match="a target space MinMaxScaler cannot be written"):
        described_space(MinMaxScaler())
