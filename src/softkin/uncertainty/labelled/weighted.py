"""Weighted conformal prediction: calibration rows count as much as their commands are likely out there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.conformal import weighted_limits
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.labelled.spec import NO_LABELS, Answer, Labelled, LabelledMethod

N_FOLDS = 5
#: No row is taken to be more certainly of one kind than this.
LEAST_PROBABILITY = 1e-6


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """Tibshirani, Barber, Candes and Ramdas (2019), with likelihood ratios from a classifier that tells the commands
    of train and calibration from the new ones (section 2.3), each judged by a fold that has not seen it.

    Its `details` come first: `domain_auc`, how well the two are told apart (0.5: not at all); `effective_size`, how
    many calibration rows are left by weight. A level whose 1/alpha exceeds the effective size is refused.
    Where the new commands lie outside those of train the likelihood ratio does not exist, and hence no guarantee.
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
    """That each command (n_rows,) is one of the new: logistic regression on squares and products, cross-fitted."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.model_selection import StratifiedKFold, cross_val_predict
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import PolynomialFeatures, StandardScaler

    classifier = make_pipeline(
        StandardScaler(),
        PolynomialFeatures(2, include_bias=False),
        StandardScaler(),
        LogisticRegression(max_iter=1000),
    )
    folds = StratifiedKFold(N_FOLDS, shuffle=True, random_state=seed)
    found = cross_val_predict(classifier, commands, is_new, cv=folds, method="predict_proba")[:, 1]
    return np.asarray(np.clip(found, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY))


METHOD = LabelledMethod("weighted", "Weighted by likelihood", NO_LABELS, NO_GUARANTEE, answer)
