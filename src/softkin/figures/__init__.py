"""Figures of one dataset: one file a kind (frame + plot), one line here."""

from __future__ import annotations

from softkin.figures import conditional_coverage, intervals
from softkin.interface import FigureSpec

FIGURES: dict[str, FigureSpec] = {
    "intervals_paper": intervals.PAPER_RECIPE,
    "intervals_chosen": intervals.CHOSEN_MODEL,
    "conditional_coverage": conditional_coverage.FIGURE,
}
