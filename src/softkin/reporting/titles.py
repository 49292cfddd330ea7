"""Titles of models and interval methods in tables, figures and the report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Titles:
    """Titles of point models, and of interval methods, regions and labelled methods, by their names."""

    models: Mapping[str, str]
    methods: Mapping[str, str]

    def run(self, model: str, preset: str) -> str:
        """'Gaussian process, tuned'."""
        return f"{self.models[model]}, {preset}"
