from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.base import clone
from sklearn.preprocessing import PolynomialFeatures

from softkin.core.samples import Array
from softkin.models.estimators.bounded_polynomial import BoundedPolynomial
from softkin.models.estimators.polynomial_terms import Terms, most_terms


def commands(n_rows: int, n_commands: int) -> Array:
    return np.random.default_rng(n_rows).uniform(-1, 1, (n_rows, n_commands))


@given(st.integers(1, 200), st.integers(1, 24), st.integers(1, 6), st.booleans())
def test_it_is_scikit_learns_where_the_rows_suffice_and_bounded_where_not(
    n_rows: int, n_commands: int, degree: int, interaction_only: bool
) -> None:
    """To the bit; what is left out is said once."""
    x = commands(n_rows, n_commands)
    own = BoundedPolynomial(degree, interaction_only)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        terms = own.fit_transform(x)
    assert terms.shape == (n_rows, len(own.terms_))
    assert terms.shape[1] <= max(most_terms(n_rows), n_commands)
    if len(Terms(n_commands, degree, interaction_only)) <= most_terms(n_rows):
        assert not caught
        expected = PolynomialFeatures(degree, interaction_only=interaction_only, include_bias=False).fit_transform(x)
        np.testing.assert_array_equal(terms, expected)
    else:
        assert len(caught) == (degree > 1)


def test_what_is_left_out_is_said() -> None:
    with pytest.warns(UserWarning, match="on 400 rows has 400 terms at most") as caught:
        BoundedPolynomial(6).fit(commands(400, 16))
    assert str(caught[0].message).startswith(
        "the polynomial of 16 commands has degree 2 (152 terms) in place of degree 6 (74612 terms): "
    )
    with pytest.warns(UserWarning, match=r"has degree 2 without products of commands \(128 terms\) in place of"):
        BoundedPolynomial(2).fit(commands(400, 64))


def test_without_products_the_powers_of_each_command_are_left() -> None:
    x = commands(30, 3)
    terms = BoundedPolynomial(3, interactions=False).fit_transform(x)
    np.testing.assert_array_equal(terms, np.hstack([x, x**2, x**3]))


def test_once_fitted_the_terms_are_fixed_and_the_settings_are_as_given() -> None:
    with pytest.warns(UserWarning, match="in place of"):
        fitted = BoundedPolynomial(4).fit(commands(20, 3))
    assert fitted.transform(commands(500, 3)).shape == (500, 19)
    assert fitted.transform(commands(1, 3)).shape == (1, 19)
    assert clone(fitted).get_params() == {"degree": 4, "interaction_only": False, "interactions": True}
    assert clone(fitted).fit_transform(commands(500, 3)).shape == (500, 34)
