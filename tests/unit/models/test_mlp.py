from __future__ import annotations

import numpy as np
import pytest
from optuna.trial import FixedTrial
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor

from softkin.core.samples import Samples
from softkin.models.estimators.fused_network import FusedNetwork
from softkin.models.estimators.last_layer_laplace import last_layer_laplace
from softkin.models.mlp import SPEC, build
from tests.conftest import bending_arm

SMALL = {"solver": "lbfgs", "activation": "tanh", "layers": 2, "width": 5, "alpha": 1e-2, "max_iter": 20}

pytestmark = pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")


@pytest.fixture(scope="module")
def train() -> Samples:
    rows = bending_arm(80)
    return Samples(rows.commands, (rows.positions - rows.positions.mean(axis=0)) / rows.positions.std(axis=0))


def test_layers_and_width_shape_the_network(train: Samples) -> None:
    network = build({**SMALL, "layers": 3}, 0, 1).fit(train.commands, train.positions)
    assert [weights.shape for weights in network.coefs_] == [(2, 5), (5, 5), (5, 5), (5, 3)]


def test_the_papers_network_has_a_seed_of_its_own_and_stops_early(train: Samples) -> None:
    one, two = (build({**SPEC.paper_params}, seed, 1) for seed in (0, 5))
    assert one.random_state == two.random_state == 1
    with pytest.warns(ConvergenceWarning):
        one.fit(train.commands, train.positions)
    assert one.n_iter_ == 12
    settings = {"hidden_layer_sizes": (100,), "random_state": 1, "max_iter": 12}
    with pytest.warns(ConvergenceWarning):
        expected = MLPRegressor(**settings).fit(train.commands, train.positions)
    np.testing.assert_array_equal(one.predict(train.commands), expected.predict(train.commands))
    assert build(SMALL, 5, 1).random_state == 5


def test_lbfgs_fits_the_fused_network(train: Samples) -> None:
    network = build(SMALL, 0, 1)
    assert isinstance(network, FusedNetwork)
    settings = {"solver": "lbfgs", "activation": "tanh", "alpha": 1e-2, "max_iter": 20, "random_state": 0}
    expected = MLPRegressor(**settings, hidden_layer_sizes=(5, 5)).fit(train.commands, train.positions)
    predicted = network.fit(train.commands, train.positions).predict(train.commands)
    np.testing.assert_allclose(predicted, expected.predict(train.commands), atol=1e-6)


def test_several_networks_see_all_rows_and_predict_their_mean(train: Samples) -> None:
    networks = build({**SMALL, "networks": 3}, 0, 1).fit(train.commands, train.positions)
    members = [network.predict(train.commands) for network in networks.estimators_]
    assert len(members) == 3
    assert not np.allclose(members[0], members[1])
    np.testing.assert_allclose(networks.predict(train.commands), np.mean(members, axis=0), rtol=1e-10)
    for rows in networks.estimators_samples_:
        np.testing.assert_array_equal(np.sort(rows), np.arange(80))


def test_the_spread_of_several_networks_is_that_of_their_mixture(train: Samples) -> None:
    assert SPEC.spread is not None
    assert SPEC.is_predictive
    networks = build({**SMALL, "networks": 3}, 0, 1).fit(train.commands, train.positions)
    each: list[MLPRegressor] = networks.estimators_
    variances = np.mean([last_layer_laplace(one, train, train.commands) ** 2 for one in each], axis=0)
    means = np.var([one.predict(train.commands) for one in each], axis=0)
    expected = np.sqrt(variances + means)
    np.testing.assert_allclose(SPEC.spread(networks, train, train.commands), expected, rtol=1e-10)
    alone = build(SMALL, 0, 1).fit(train.commands, train.positions)
    spread = SPEC.spread(alone, train, train.commands)
    np.testing.assert_allclose(spread, last_layer_laplace(alone, train, train.commands), rtol=1e-10)


def test_the_spread_around_a_trend_is_in_the_unit_of_the_targets(train: Samples) -> None:
    assert SPEC.spread is not None
    fitted = build({**SMALL, "trend": "linear"}, 0, 1).fit(train.commands, train.positions)
    inner = last_layer_laplace(fitted.regressor_, fitted.residuals(train), train.commands)
    np.testing.assert_allclose(SPEC.spread(fitted, train, train.commands), inner * fitted.scale_, rtol=1e-10)


def test_a_learning_rate_belongs_to_adam_and_several_networks_to_lbfgs() -> None:
    common = {"trend": "none", "layers": 1, "width": 16, "activation": "relu", "alpha": 1e-3}
    adam = SPEC.search_space(FixedTrial({**common, "solver": "adam", "learning_rate_init": 1e-3}))
    lbfgs = SPEC.search_space(FixedTrial({**common, "solver": "lbfgs", "networks": 3}))
    assert set(adam) - set(lbfgs) == {"learning_rate_init", "n_iter_no_change"}
    assert set(lbfgs) - set(adam) == {"networks"}
