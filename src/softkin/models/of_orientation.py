"""Candidates for a model of the tip's orientation: two models of the pool with parameters that its studies begin with.

No study is spent on an orientation: both learn their smoothness, or have little to tune, and cross-validation on
`train` chooses.
"""

from __future__ import annotations

from softkin.core.samples import Params
from softkin.models import gaussian_process, ridge
from softkin.models.spec import ModelSpec

CANDIDATES: list[tuple[ModelSpec, Params]] = [
    (spec, dict(params)) for spec in (ridge.SPEC, gaussian_process.SPEC) for params in spec.first_trials
]
