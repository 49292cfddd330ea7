"""Weighted conformal prediction under covariate shift: calibration rows count by the likelihood ratio of commands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.conformal import weighted_limits
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.labelled.spec import NO_LABELS, Answer, Labelled, LabelledMethod

N_FOLDS = 5
#: Probabilities are clipped to this and one minus this.
LEAST_PROBABILITY = 1e-6


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """Tibshirani, Barber, Candes and Ramdas (2019), with likelihood ratios from a classifier between the commands of
    `train` and calibration and the new ones (section 2.3), cross-fitted.

    Its `details`: `domain_auc`, the AUC of the classifier (0.5: the two are alike); `effective_size`, the effective
    number of calibration rows by weight. A level whose 1/alpha exceeds the effective size is refused. In extrapolation
    the likelihood ratio does not exist, hence no guarantee.
    """
    from sklearn.metrics import roc_auc_score

    n_train, n = len(labelled.train_commands), len(labelled.calibration_commands)
    known = np.concatenate([labelled.train_commands, labelled.calibration_commands])
    is_new = np.repeat([0, 1], [len(known), len(labelled.commands)])
    probability = _probability_new(np.concatenate([known, labelled.commands]), is_new, seed)
    ratios = probability / (1 - probability)
    weights, own = ratios[n_train : n_train + n], ratios[n_train + n :]
    size = float(weights.sum() ** 2 / (weights**2).sum())
    halves = weighted_limits(np.abs(labelled.calibration_errors), weights, own, confidence_levels)
    refused = [
        f"{size:.1f} effective calibration rows, fewer than 1/alpha" if size * (1 - level) < 1 - 1e-9 else ""
        for level in confidence_levels
    ]
    details = {"domain_auc": float(roc_auc_score(is_new, probability)), "effective_size": size}
    return Answer(halves, np.arange(len(labelled.errors)), refused, details)


def _probability_new(commands: Array, is_new: Array, seed: int) -> Array:
    """Probability (n_rows,) that each command is a new one: cross-fitted logistic regression on quadratic features."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.model_selection import StratifiedKFold, cross_val_predict
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from softkin.models.estimators.bounded_polynomial import BoundedPolynomial

    classifier = make_pipeline(
        StandardScaler(),
        BoundedPolynomial(2),
        StandardScaler(),
        LogisticRegression(max_iter=1000),
    )
    folds = StratifiedKFold(N_FOLDS, shuffle=True, random_state=seed)
    probability = cross_val_predict(classifier, commands, is_new, cv=folds, method="predict_proba")[:, 1]
    return np.asarray(np.clip(probability, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY))


METHOD = LabelledMethod("weighted", "Weighted by likelihood ratio", NO_LABELS, NO_GUARANTEE, answer)
