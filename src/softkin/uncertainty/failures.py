"""Failures as a class: the probability that a pose fails, as where a simulation does not converge.

A failed pose is wrong by far more than its neighbours, and no interval around a prediction tells where it is. Where
commands decide whether poses fail, `train` tells the probability; where they do not, there is no such class.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import mannwhitneyu

from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.audit.gross_rows import gross_rows
from softkin.models.plain.describe_trees import of_one_tree
from softkin.models.plain.kernels import Node

#: So many failed rows of `train` there must be, and of regular ones: each of five folds tests on some.
FEWEST_ROWS = 10
#: Commands must tell failed rows from regular ones, held out, by a rank test of this size.
LARGEST_P_VALUE = 1e-3
#: A leaf of the classifier has so many rows: fewer are no region.
LEAF_ROWS, N_FOLDS = 5, 5


@dataclass(frozen=True)
class FailureClass:
    """What `train` tells of failed poses.

    `classifier` has the probability; `lower` and `upper` (n_coordinates,) in mm is where failed poses of `train` lie;
    `n_failed` of `n_rows` rows failed there.
    """

    classifier: Any
    lower: Array
    upper: Array
    n_failed: int
    n_rows: int

    def probability(self, commands: Array) -> Array:
        """Probability (n_rows,) that the pose at each command (n_rows, n_commands) fails."""
        tree, of_nodes = self._of_nodes
        with np.errstate(over="ignore"):  # the tree compares numbers of 32 bits
            rows = commands.astype(np.float32)
        return np.asarray(of_nodes[tree.apply(rows)])

    @cached_property
    def _of_nodes(self) -> tuple[Any, Array]:
        """The tree, and the probability (n_nodes,) in each of its nodes. The classifier answers the same, but takes ten
        times as long for one command as all else.
        """
        (fitted,) = self.classifier.calibrated_classifiers_
        tree = fitted.estimator.tree_
        return tree, np.asarray(fitted.calibrators[0].predict(tree.value[:, 0, 1]))

    def may_fail(self, commands: Array, confidence_levels: Any) -> NDArray[np.bool_]:
        """Where (n_levels, n_rows) no interval around the prediction can hold at its level, since the pose fails with
        more than the miscoverage; and with more than the share of `train` that failed.
        """
        return np.asarray(self.probability(commands) > self._least(confidence_levels)[:, None])

    def widened(self, bounds: Array, commands: Array, confidence_levels: Any) -> Array:
        """Bounds (n_levels, n_rows, n_coordinates, 2) in mm that hold the failed poses of `train`, too, where poses may
        fail.
        """
        probability = self.probability(commands)
        if probability.max(initial=0.0) <= self.n_failed / self.n_rows:
            return bounds
        failed = np.stack([np.minimum(bounds[..., 0], self.lower), np.maximum(bounds[..., 1], self.upper)], axis=-1)
        may_fail = probability > self._least(confidence_levels)[:, None]
        return np.where(may_fail[..., None, None], failed, bounds)

    def numbers(self, confidence_levels: Any) -> Node:
        """All that `MayFail` answers from, in plain numbers, at these levels."""
        tree, of_nodes = self._of_nodes
        node: Node = {"tree": of_one_tree(tree, of_nodes[:, None]), "least": self._least(confidence_levels)}
        return node | {"lower": self.lower, "upper": self.upper}

    def _least(self, confidence_levels: Any) -> Array:
        """The probability (n_levels,) that a pose which may fail exceeds."""
        return np.asarray(np.maximum(1 - np.asarray(confidence_levels, dtype=float), self.n_failed / self.n_rows))


def failure_class(train: Samples, seed: int = 0) -> FailureClass | None:
    """The class of failures that `train` shows: its gross errors by the audit, where commands foretell them.

    A decision tree, whose leaves are the thin regions that simulations fail in, calibrated on held-out folds by
    Platt's sigmoid. There is a class where at least `FEWEST_ROWS` failed, and where the probabilities of rows held out
    are higher for failed ones (Mann and Whitney 1947): markers that are lost at random make none.
    Source: sklearn.tree.DecisionTreeClassifier, sklearn.calibration.CalibratedClassifierCV.

    Parameters:
        train: rows of `train`.
        seed: of the folds and of the audit.
    """
    from sklearn.calibration import CalibratedClassifierCV
    from sklearn.model_selection import StratifiedKFold, cross_val_predict
    from sklearn.tree import DecisionTreeClassifier

    failed = gross_rows({TRAIN: train}, seed)[TRAIN]
    if min(failed.sum(), (~failed).sum()) < FEWEST_ROWS:
        return None
    inner, outer = (StratifiedKFold(N_FOLDS, shuffle=True, random_state=seed + place) for place in (0, 1))
    tree = DecisionTreeClassifier(min_samples_leaf=LEAF_ROWS, random_state=seed)
    classifier = CalibratedClassifierCV(tree, method="sigmoid", cv=inner, ensemble=False)
    held_out = cross_val_predict(classifier, train.commands, failed, cv=outer, method="predict_proba")[:, 1]
    if mannwhitneyu(held_out[failed], held_out[~failed], alternative="greater").pvalue > LARGEST_P_VALUE:
        return None
    poses = train.positions[failed]
    classifier.fit(train.commands, failed)
    return FailureClass(classifier, poses.min(axis=0), poses.max(axis=0), int(failed.sum()), len(failed))
