"""Check for shifted subsets: per column the Kolmogorov-Smirnov and Wasserstein distances from `train`, and the
cross-validated AUC of a classifier of commands and their norm: 0.5 is chance, 1 separates the subsets without fail.

Validation and test should be indistinguishable from train, extrapolation should not be.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from softkin.core.rows import command_scale, sampled_rows
from softkin.core.samples import (
    EXTRAPOLATION,
    TEST,
    TRAIN,
    VALIDATION,
    Array,
    Samples,
    command_columns,
    coordinate_columns,
    informative_coordinates,
)
from softkin.data.audit.findings import WARNING, CheckResult, Finding

#: A difference is a finding where it is both large and not chance: a KS distance, a distance of the AUC from 0.5, and
#: how often chance brings as much (KS: over all columns together; AUC: in standard errors of the rank statistic).
LARGE_KS, LARGE_AUC = 0.1, 0.1
CHANCE_KS, CHANCE_AUC_ERRORS = 1e-6, 5.0
#: Extrapolation is like train where its AUC is below this by so many standard errors.
ALIKE_AUC, SURE_ERRORS = 0.65, 3.0
MAX_ROWS_CLASSIFIED, MAX_ROWS_COMPARED = 2_000, 20_000
N_FOLDS, FEWEST_ROWS = 3, 20
#: With fewer rows in either, the asymptotic p-value of a KS distance is wrong: 0 for a single row.
ASYMPTOTIC_FROM = 100


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """A finding for validation and test where they differ from train, and for extrapolation where it does not."""
    findings = []
    numbers: dict[str, Any] = {}
    for subset in (VALIDATION, TEST, EXTRAPOLATION):
        columns, p_values = _distances(samples[TRAIN], samples[subset], seed)
        auc, error = _auc(samples[TRAIN].commands, samples[subset].commands, seed)
        numbers[subset] = {"auc": auc, "columns": columns}
        worst = max(columns, key=lambda name: columns[name]["ks"])
        too_far = columns[worst]["ks"] > LARGE_KS and p_values[worst] * len(columns) < CHANCE_KS
        separable = auc is not None and auc > 0.5 + LARGE_AUC and auc > 0.5 + CHANCE_AUC_ERRORS * error
        if subset != EXTRAPOLATION and (too_far or separable):
            difference = f"they differ most in {worst} (KS distance {columns[worst]['ks']:.2f})"
            if auc is not None:
                difference += f", and a classifier of commands separates them with an AUC of {auc:.2f} (chance: 0.5)"
            findings.append(
                Finding(
                    "shifted_subset",
                    WARNING,
                    (subset,),
                    f"The rows of {subset} are not drawn like those of train: {difference}.",
                    "The intervals have their coverage only where validation and test are drawn alike, and scores are "
                    "partly extrapolation. Was the robot changed, or were the data split by time?",
                )
            )
        if subset == EXTRAPOLATION and auc is not None and auc + SURE_ERRORS * error < ALIKE_AUC:
            findings.append(
                Finding(
                    "extrapolation_like_train",
                    WARNING,
                    (subset,),
                    f"The rows of extrapolation look like those of train (AUC {auc:.2f}, where chance is 0.5).",
                    "This subset is a second test subset: its scores do not tell how a model extrapolates.",
                )
            )
    limits = {"rows_classified_at_most": MAX_ROWS_CLASSIFIED, "rows_compared_at_most": MAX_ROWS_COMPARED}
    return CheckResult(tuple(findings), limits | numbers)


def _distances(train: Samples, other: Samples, seed: int) -> tuple[dict[str, dict[str, float]], dict[str, float]]:
    """Per column KS and Wasserstein distance, and the p-value of the former.

    Commands are in standard deviations on train, positions in mm; constant coordinates are left out.
    """
    from scipy.stats import ks_2samp, wasserstein_distance

    scale = command_scale(train.commands)
    train_rows, other_rows = (sampled_rows(len(rows), MAX_ROWS_COMPARED, seed) for rows in (train, other))
    moving = informative_coordinates(train.positions)
    coordinates = np.array(coordinate_columns(len(moving) // 3))
    names = [*command_columns(len(scale)), *coordinates[moving].tolist()]
    left = np.hstack([train.commands[train_rows] / scale, train.positions[train_rows][:, moving]])
    right = np.hstack([other.commands[other_rows] / scale, other.positions[other_rows][:, moving]])
    columns, p_values = {}, {}
    for name, a, b in zip(names, left.T, right.T, strict=True):
        ks = ks_2samp(a, b, method="exact" if min(len(a), len(b)) < ASYMPTOTIC_FROM else "asymp")
        columns[name] = {"ks": float(ks.statistic), "wasserstein": float(wasserstein_distance(a, b))}
        p_values[name] = float(ks.pvalue)
    return columns, p_values


def _auc(train: Array, other: Array, seed: int) -> tuple[float | None, float]:
    """Cross-validated AUC of a classifier of commands and their norm, and its standard error under chance; None with
    too few rows.
    """
    from sklearn.ensemble import HistGradientBoostingClassifier
    from sklearn.metrics import roc_auc_score
    from sklearn.model_selection import StratifiedKFold, cross_val_predict

    parts = [part[sampled_rows(len(part), MAX_ROWS_CLASSIFIED, seed)] for part in (train, other)]
    n_train, n_other = map(len, parts)
    if min(n_train, n_other) < FEWEST_ROWS:
        return None, 0.0
    is_other = np.repeat([0, 1], [n_train, n_other])
    classifier = HistGradientBoostingClassifier(max_iter=50, max_depth=4, early_stopping=False, random_state=seed)
    folds = StratifiedKFold(N_FOLDS, shuffle=True, random_state=seed)
    commands = np.vstack(parts)
    features = np.column_stack([commands, np.linalg.norm(commands, axis=1)])
    scores = cross_val_predict(classifier, features, is_other, cv=folds, method="predict_proba")[:, 1]
    auc = float(roc_auc_score(is_other, scores))
    # Variance of the Mann-Whitney statistic where the subsets are alike (Hanley and McNeil 1982).
    error = np.sqrt((n_train + n_other + 1) / (12 * n_train * n_other))
    return auc, float(error)
