"""Hashes of the params of a job, by which it is noticed that a result was made with others."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any


def params_hashes(params: Mapping[str, Any]) -> dict[str, str]:
    """SHA-256 (hex) of each of `params`, whatever the order of keys within it."""
    return {
        name: hashlib.sha256(json.dumps(value, sort_keys=True, default=str).encode()).hexdigest()
        for name, value in params.items()
    }


def other_params(recorded: Mapping[str, str], params: Mapping[str, Any]) -> list[str]:
    """The names, sorted, of `params` that are not as their hashes were `recorded`, or that came or went."""
    now = params_hashes(params)
    return sorted(name for name in {*recorded, *now} if recorded.get(name) != now.get(name))
