from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

import pytest

from softkin.core import distributions
from softkin.core.distributions import SAME_LIBRARY, installed
from softkin.training.study import DECIDING_PACKAGES


def test_a_library_has_the_version_of_its_distribution() -> None:
    assert installed("numpy") == ("numpy", version("numpy"))
    for name in DECIDING_PACKAGES:
        assert installed(name)[1][0].isdigit()
    with pytest.raises(PackageNotFoundError, match="no-such-library"):
        installed("no-such-library")


@pytest.mark.parametrize("name", SAME_LIBRARY[0])
@pytest.mark.parametrize("there", SAME_LIBRARY[0])
def test_either_distribution_of_a_library_will_do(name: str, there: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def only_one(distribution: str) -> str:
        if distribution != there:
            raise PackageNotFoundError(distribution)
        return "3.2.0"

    monkeypatch.setattr(distributions, "version", only_one)
    assert installed(name) == (there, "3.2.0")


def test_a_library_without_any_of_its_distributions_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(distribution: str) -> str:
        raise PackageNotFoundError(distribution)

    monkeypatch.setattr(distributions, "version", none)
    with pytest.raises(PackageNotFoundError, match="xgboost-cpu"):
        installed("xgboost-cpu")
