from __future__ import annotations

import numpy as np
from sklearn.base import clone

from softkin.models.estimators.refitted import Refits, Refitted, key

ROWS = np.arange(6.0)
FOLDS = [np.array([0.0, 1.0, 2.0, 3.0]), np.array([2.0, 3.0, 4.0, 5.0])]
OF_ALL = np.full(6, -1.0)
REFITS = Refits({key(rows): 10.0 * place + np.arange(6.0) for place, rows in enumerate(FOLDS)}, OF_ALL)


def test_a_fit_finds_the_refit_on_its_rows_and_predicts_what_that_predicted() -> None:
    for place, rows in enumerate(FOLDS):
        model = Refitted(REFITS).fit(rows[:, None], np.zeros(len(rows)))
        np.testing.assert_array_equal(model.predict(np.array([[5.0], [0.0]])), 10.0 * place + np.array([5.0, 0.0]))


def test_rows_that_were_never_refitted_on_get_the_predictions_of_all() -> None:
    model = Refitted(REFITS).fit(ROWS[:, None], np.zeros(6))
    np.testing.assert_array_equal(model.predict(ROWS[:, None]), OF_ALL)


def test_a_clone_shares_the_stored_predictions() -> None:
    assert clone(Refitted(REFITS)).refits is REFITS


def test_the_key_is_the_rows_in_their_order_of_whatever_type() -> None:
    assert key(FOLDS[0]) == key(FOLDS[0].astype(np.int64)) == key(FOLDS[0].astype(np.int32))
    assert len({key(FOLDS[0]), key(FOLDS[0][::-1]), key(FOLDS[1])}) == 3
