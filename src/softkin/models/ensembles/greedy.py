"""Greedy selection of runs with replacement: the run that helps the mean most is added, again and again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from softkin.models.ensembles.spec import EnsembleSpec

if TYPE_CHECKING:
    from softkin.core.samples import Array

#: Runs that are added, each as often as it helps; different ones at most, which bounds the time of a prediction.
N_STEPS, MOST_MEMBERS = 10, 5


def steps(predicted: Array, truth: Array, shares: Array) -> Array:
    """Weights (n_steps, n_runs) after each run that is added; of equal ones the first is added.

    The run is added with which the mean of all so far errs least, by the mean absolute error. Source: Caruana,
    Niculescu-Mizil, Crew and Ksikes (2004), Ensemble selection from libraries of models, section 2.
    """
    import numpy as np

    counts = np.zeros((N_STEPS, len(predicted)))
    total = np.zeros_like(truth)
    chosen: list[int] = []
    for step in range(N_STEPS):
        allowed = sorted(set(chosen)) if len(set(chosen)) == MOST_MEMBERS else range(len(predicted))
        errors = [float(shares @ np.abs((total + predicted[run]) / (step + 1) - truth).mean(axis=1)) for run in allowed]
        chosen.append(list(allowed)[int(np.argmin(errors))])
        total = total + predicted[chosen[-1]]
        counts[step] = np.bincount(chosen, minlength=len(predicted))
    return np.asarray(counts / counts.sum(axis=1, keepdims=True))


SPEC = EnsembleSpec(name="ensemble", title="Ensemble", family="ensemble", steps=steps)
