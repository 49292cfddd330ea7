"""Rows that a fit sees: all of them, or as many as its bound allows."""

from __future__ import annotations

import logging

from softkin.core.rows import sampled_rows
from softkin.core.samples import Samples

logger = logging.getLogger("softkin")


def some_rows(samples: Samples, max_rows: int | None, seed: int, key: str = "max_fit_rows") -> Samples:
    """At most `max_rows` rows, drawn without replacement, in their order; all where it is None. The log names the `key`
    of the configuration that bounds them.
    """
    if max_rows is None or len(samples) <= max_rows:
        return samples
    logger.warning("fitted on %d of %d rows: %s", max_rows, len(samples), key)
    return samples.take(sampled_rows(len(samples), max_rows, seed))
