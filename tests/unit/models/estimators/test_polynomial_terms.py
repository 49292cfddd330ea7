from __future__ import annotations

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from sklearn.preprocessing import PolynomialFeatures

from softkin.core.samples import Params
from softkin.models import MODELS
from softkin.models.estimators.polynomial_terms import (
    MAX_BYTES,
    MAX_TERMS,
    Terms,
    bounded_degree,
    bounded_terms,
    bounded_trend,
    most_terms,
)
from softkin.training.refit_shells import LEAST_CORE_SHARE
from tests.conftest import HOUSE
from tests.contract.laws import drawn_params, first_params

KINDS = st.builds(Terms, st.integers(1, 64), st.integers(1, 6), st.booleans())
ROWS = st.integers(1, 2_000_000)


@given(KINDS)
def test_terms_are_counted_as_scikit_learn_counts_them(terms: Terms) -> None:
    features = PolynomialFeatures(terms.degree, interaction_only=terms.interaction_only, include_bias=False)
    assert len(terms) == features.fit([[0.0] * terms.n_commands]).n_output_features_


@given(KINDS, ROWS)
def test_a_fit_has_no_more_terms_than_its_rows_and_the_memory_allow(wanted: Terms, n_rows: int) -> None:
    """Unless these are fewer than the commands, which always stay; and no fewer than it must."""
    terms = bounded_terms(wanted, n_rows)
    assert len(terms) <= max(min(n_rows, MAX_TERMS, MAX_BYTES / (8 * n_rows)), wanted.n_commands)
    assert terms.degree <= wanted.degree
    if len(wanted) <= most_terms(n_rows):
        assert terms == wanted
    for more in [wanted, *wanted.fewer()]:
        if more == terms:
            break
        assert len(more) > most_terms(n_rows)


@given(KINDS, ROWS, ROWS)
def test_more_rows_within_the_memory_have_no_fewer_terms(wanted: Terms, first: int, second: int) -> None:
    few, many = sorted((first % 64_000 + 1, second % 64_000 + 1))
    assert len(bounded_terms(wanted, few)) <= len(bounded_terms(wanted, many))


@given(KINDS)
def test_terms_become_fewer_and_end_at_the_commands(terms: Terms) -> None:
    counts = [len(terms), *map(len, terms.fewer())]
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] == terms.n_commands


@pytest.mark.parametrize(
    ("n_commands", "n_rows", "degree", "interactions", "n_terms"),
    [
        (2, 10_000, 6, True, 27),
        (6, 10_000, 6, True, 923),
        (6, 640, 5, True, 461),
        (16, 10_000, 3, True, 968),
        (64, 10_000, 2, False, 128),
        (64, 100, 1, True, 64),
        (64, 20, 1, True, 64),
        (6, 1_000_000, 2, True, 27),
    ],
)
def test_degree_six_by_commands_and_rows(
    n_commands: int, n_rows: int, degree: int, interactions: bool, n_terms: int
) -> None:
    terms = bounded_terms(Terms(n_commands, 6), n_rows)
    assert (terms.degree, terms.interactions, len(terms)) == (degree, interactions, n_terms)


@pytest.mark.parametrize(
    ("params", "n_commands", "n_rows", "bounded"),
    [
        ({"degree": 6}, 3, 100, {"degree": 6}),
        ({"degree": 6, "alpha": 1.0}, 6, 640, {"degree": 5, "alpha": 1.0}),
        ({"degree": 3}, 64, 640, {"degree": 2, "interactions": False}),
        ({"degree": 2}, 64, 100, {"degree": 1}),
        ({"degree": 3, "interaction_only": True}, 16, 640, {"degree": 2, "interaction_only": True}),
        ({}, 64, 10, {}),
    ],
)
def test_a_degree_becomes_that_of_the_fit(params: Params, n_commands: int, n_rows: int, bounded: Params) -> None:
    assert bounded_degree(params, n_commands, n_rows) == bounded


@pytest.mark.parametrize(
    ("trend", "n_commands", "n_rows", "bounded"),
    [
        ("quadratic", 16, 640, {"trend": "quadratic"}),
        ("quadratic", 64, 640, {"trend": "quadratic", "interactions": False}),
        ("quadratic", 64, 100, {"trend": "linear"}),
        ("linear", 64, 10, {"trend": "linear"}),
        ("none", 64, 10, {"trend": "none"}),
    ],
)
def test_a_trend_becomes_that_of_the_fit(trend: str, n_commands: int, n_rows: int, bounded: Params) -> None:
    params = {"trend": trend, "max_depth": 3}
    assert bounded_trend(params, n_commands, n_rows) == {**bounded, "max_depth": 3}


def test_no_published_robot_is_bounded() -> None:
    """In no fit of the default configuration: on all rows, folds, bootstrap samples and the smallest core."""
    config = yaml.safe_load((HOUSE / "config" / "config.yaml").read_text())
    tuning = config["tuning"]
    sources = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
    published = [source for source in sources.values() if "urls" in source]
    assert len(published) == 5
    for source in published:
        in_trials = min(source["rows"]["train"], tuning["max_rows"])
        shares = [*tuning["core_shares"], 1 - 1 / tuning["n_folds"]]
        fewest = min(int(min(shares) * in_trials), int(LEAST_CORE_SHARE * source["rows"]["train"]))
        for spec in MODELS.values():
            for params in (spec.paper_params, *first_params(spec), *drawn_params(spec, 40)):
                for n_rows in (fewest, source["rows"]["train"]):
                    assert spec.bounded(params, source["n_commands"], n_rows) == params
