"""On which of its models or methods a job failed, said in its log: tables can be made without that one."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

logger = logging.getLogger("softkin")

#: Keys of the configuration whose entries a dataset can do without, and what an entry is called.
MODELS, QUANTILE_MODELS, INTERVAL_METHODS, REGIONS = ("models", "quantile_models", "interval_methods", "regions")
ENSEMBLES = "ensembles"
PARTS = {
    MODELS: "model",
    ENSEMBLES: "ensemble",
    QUANTILE_MODELS: "quantile regressor",
    INTERVAL_METHODS: "interval method",
    REGIONS: "region",
}
_SAID = re.compile(rf" failed on the ({'|'.join(PARTS.values())}) (\w+)$", re.MULTILINE)


@contextmanager
def of_part(key: str, name: str) -> Iterator[None]:
    """Say in the log that the job failed on an entry of this key of the configuration, where the block raises."""
    try:
        yield
    except Exception:
        logger.warning("the job failed on the %s %s", PARTS[key], name)
        raise


def failed_parts(log: str | Path) -> list[tuple[str, str]]:
    """(key, name) of what a job failed on, as its log says; empty where it says nothing, or where there is none."""
    if not Path(log).is_file():
        return []
    keys = {words: key for key, words in PARTS.items()}
    said = _SAID.findall(Path(log).read_text(encoding="utf-8", errors="replace"))
    return [(keys[words], name) for words, name in said]
