"""Registry of ensembles: ways to weight the runs of a dataset, one file a way, one line here."""

from __future__ import annotations

from softkin.models.ensembles import greedy
from softkin.models.ensembles.spec import EnsembleSpec

ENSEMBLES: dict[str, EnsembleSpec] = {
    "ensemble": greedy.SPEC,
}
