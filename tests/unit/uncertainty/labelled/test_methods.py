from __future__ import annotations

import numpy as np
import pytest
from mapie.conformity_scores import AbsoluteConformityScore
from mapie.regression import TimeSeriesRegressor

from softkin.core.samples import Array
from softkin.models.estimators.column import Column
from softkin.uncertainty.conformal import conformal_rank, global_random_state_kept, weighted_limits
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.labelled.adaptive import STEP, trajectory
from softkin.uncertainty.labelled.few_labels import N_LABELS
from softkin.uncertainty.labelled.spec import Labelled

LEVELS = (0.8, 0.9, 0.95)


def norm(rows: Array) -> Array:
    return np.asarray(np.linalg.norm(rows, axis=1))


def labelled(n: int = 140, m: int = 200, seed: int = 0, reach: tuple[float, float] = (0.0, 1.0)) -> Labelled:
    """Errors grow with the norm of the command; new commands lie between the two norms of `reach`."""
    rng = np.random.default_rng(seed)

    def commands(rows: int, low: float, high: float) -> Array:
        angle = rng.uniform(0, 2 * np.pi, rows)
        return np.asarray(rng.uniform(low, high, rows)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))

    def errors(at: Array) -> Array:
        return np.asarray(rng.standard_normal((len(at), 3)) * (0.5 + norm(at))[:, None])

    train, calibration, new = commands(400, 0, 1), commands(n, 0, 1), commands(m, *reach)
    return Labelled(train, calibration, errors(calibration), new, errors(new), norm)


@pytest.mark.parametrize("method", LABELLED_METHODS)
def test_every_method_answers_in_the_house_shape_and_levels_are_nested(method: str) -> None:
    given = labelled()
    found = LABELLED_METHODS[method].answer(given, LEVELS, 0)
    assert LABELLED_METHODS[method].name == method
    assert found.half_widths.shape == (3, len(found.scored), 3)
    assert set(found.scored) <= set(range(200))
    assert list(found.refused) == [""] * 3
    if method != "adaptive":  # each level adapts by itself
        assert (np.diff(found.half_widths, axis=0) >= 0).all()


@pytest.mark.parametrize("method", ["oracle", "few_labels", "few_labels_distance", "weighted"])
def test_coverage_inside_is_what_is_promised(method: str) -> None:
    """300 draws in which new rows are like the calibration rows."""
    shares = []
    for seed in range(300 if method != "weighted" else 60):
        given = labelled(seed=seed)
        found = LABELLED_METHODS[method].answer(given, LEVELS, seed)
        shares.append((np.abs(given.errors[found.scored]) <= found.half_widths).mean(axis=(1, 2)))
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(len(shares))
    for level, mean, error in zip(LEVELS, means, errors, strict=True):
        assert level - 4 * error - 1e-9 <= mean <= level + 0.06


def test_the_oracle_leaves_each_row_out_of_its_own_calibration() -> None:
    given = labelled(m=50)
    found = LABELLED_METHODS["oracle"].answer(given, LEVELS, 0)
    scores = np.abs(given.errors)
    for place, level in enumerate(LEVELS):
        rank = conformal_rank(49, level)
        assert rank is not None
        for row in range(50):
            rest = np.sort(np.delete(scores, row, axis=0), axis=0)
            np.testing.assert_array_equal(found.half_widths[place, row], rest[rank - 1])
    assert np.isinf(LABELLED_METHODS["oracle"].answer(labelled(m=10), [0.95], 0).half_widths).all()


def test_few_labels_are_drawn_by_the_seed_and_never_scored() -> None:
    given = labelled()
    one, same, other = (LABELLED_METHODS["few_labels"].answer(given, LEVELS, seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.half_widths, same.half_widths)
    assert len(one.scored) == 200 - N_LABELS
    assert set(one.scored) != set(other.scored)
    known = np.setdiff1d(np.arange(200), one.scored)
    rank = conformal_rank(N_LABELS, 0.9)
    assert rank is not None
    expected = np.sort(np.abs(given.errors[known]), axis=0)[rank - 1]
    np.testing.assert_array_equal(one.half_widths[1], np.broadcast_to(expected, (180, 3)))
    wider = LABELLED_METHODS["few_labels_distance"].answer(labelled(reach=(1.0, 2.0)), LEVELS, 0)
    out = np.argsort(norm(labelled(reach=(1.0, 2.0)).commands[wider.scored]))
    assert wider.half_widths[1, out[-1], 0] > 1.5 * wider.half_widths[1, out[0], 0]
    refused = LABELLED_METHODS["few_labels"].answer(labelled(m=N_LABELS), LEVELS, 0)
    assert len(refused.scored) == 0
    assert all("20 rows, of which 20" in reason for reason in refused.refused)


def test_equal_weights_are_split_conformal_and_a_heavy_new_row_has_an_infinite_interval() -> None:
    scores = np.abs(labelled().calibration_errors)
    plain = weighted_limits(scores, np.full(140, 2.5), np.full(4, 2.5), LEVELS)
    for level, limits in zip(LEVELS, plain, strict=True):
        rank = conformal_rank(140, level)
        assert rank is not None
        np.testing.assert_array_equal(limits, np.broadcast_to(np.sort(scores, axis=0)[rank - 1], (4, 3)))
    halves = weighted_limits(np.array([[3.0], [1.0], [2.0]]), np.array([1.0, 2.0, 3.0]), np.array([0.0, 4.0]), [0.5])
    np.testing.assert_array_equal(halves[0, :, 0], [2.0, 2.0])
    assert np.isinf(weighted_limits(scores, np.ones(140), np.array([36.0]), [0.8])).all()


def test_weighted_by_likelihood_tells_first_and_refuses_where_nothing_is_left() -> None:
    inside, outside = (LABELLED_METHODS["weighted"].answer(labelled(reach=r), LEVELS, 0) for r in ((0, 1), (1.1, 2.0)))
    assert inside.details["domain_auc"] < 0.6
    assert inside.details["effective_size"] > 100
    assert outside.details["domain_auc"] > 0.999
    assert np.isinf(outside.half_widths).mean() > 0.99
    nothing = LABELLED_METHODS["weighted"].answer(labelled(n=12, reach=(1.1, 2.0)), [0.8, 0.95], 0)
    size = nothing.details["effective_size"]
    assert size < 20
    assert nothing.refused[1] == f"{size:.1f} effective calibration rows, fewer than 1/alpha"


def test_weights_mend_a_shift_that_stays_within_train() -> None:
    """New commands from the outer third of the disc: plain split conformal prediction covers too little of them."""
    plain, weighted = [], []
    for seed in range(60):
        given = labelled(n=400, seed=seed, reach=(0.6, 1.0))
        errors = np.abs(given.errors)
        equal = weighted_limits(np.abs(given.calibration_errors), np.ones(400), np.ones(200), [0.9])[0]
        plain.append((errors <= equal).mean())
        weighted.append((errors <= LABELLED_METHODS["weighted"].answer(given, [0.9], 0).half_widths[0]).mean())
    assert np.mean(plain) < 0.87
    assert 0.89 < np.mean(weighted) < 0.95


def test_adaptive_misses_as_often_as_wanted_whatever_comes() -> None:
    """Gibbs and Candes, proposition 4.1, on errors that grow a hundredfold on the way."""
    rng = np.random.default_rng(0)
    scores = np.abs(rng.standard_normal((500, 4))) * np.geomspace(1, 100, 500)[:, None]
    start = np.abs(rng.standard_normal((100, 4)))
    for level in LEVELS:
        misses = (scores > trajectory(start, scores, level)).mean(axis=0)
        bound = (max(level, 1 - level) + STEP) / (STEP * 500)
        assert (np.abs(misses - (1 - level)) <= bound).all()
        frozen = np.sort(start, axis=0)[int(level * 101)]
        assert ((scores > frozen).mean(axis=0) > 0.5).all()


def test_adaptive_is_mapies_where_it_does_not_clip() -> None:
    """MAPIE as it is used: predict a row, adapt the level, update the scores."""
    rng = np.random.default_rng(3)
    start, scores = rng.standard_normal(60), rng.standard_normal(40)
    ours = trajectory(np.abs(start)[:, None], np.abs(scores)[:, None], 0.8, step=0.01)[:, 0]
    zero = np.zeros((1, 1))
    with global_random_state_kept():
        mapie = TimeSeriesRegressor(
            Column(0), method="aci", cv="prefit", conformity_score=AbsoluteConformityScore(sym=True)
        )
        mapie.fit(np.zeros((60, 1)), start)
        theirs = []
        for score in scores:
            _, bounds = mapie.predict(zero, confidence_level=0.8, allow_infinite_bounds=True)
            theirs.append(float(bounds[0, 1, 0]))
            mapie.adapt_conformal_inference(zero, np.array([score]), gamma=0.01)
            with pytest.warns(UserWarning, match="changed"):
                mapie.update(zero, np.array([score]))
    np.testing.assert_allclose(ours, theirs, atol=1e-12)
    assert len(np.unique(ours)) > 5
