"""One style for all figures: text readable at the width of a page, colours that the colour-blind tell apart."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.core.escaping import figure_text
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, VALIDATION
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.quantile import QUANTILE_MODELS
from softkin.reporting.figures.sampling import sample_notes
from softkin.reporting.figures.spec import DatasetResults

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

#: Okabe and Ito (2008).
BLUE, ORANGE, GREEN, VERMILION, SKY, PURPLE, YELLOW, BLACK = PALETTE = (
    *("#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7", "#F0E442", "#000000"),
)
GREY, LIGHT = "#666666", "#bbbbbb"
SUBSET_COLOURS = {TRAIN: GREY, VALIDATION: GREEN, TEST: BLUE, EXTRAPOLATION: VERMILION}

#: Tol's muted scheme and one of his browns (personal.sron.nl/~pault); black is kept for true positions. Each model has
#: a mark of its own, too, for prints in grey. Ten colours and eleven marks give 110 different looks.
MODEL_COLOURS = (
    *("#CC6677", "#332288", "#DDCC77", "#117733", "#88CCEE", "#882255", "#44AA99", "#999933", "#AA4499", "#661100"),
)
MODEL_MARKS = "os^DvPX*<>h"
#: (colour, mark) by the place in the registries, whatever is configured: the same in every figure of every run.
LOOKS = {
    name: (MODEL_COLOURS[place % len(MODEL_COLOURS)], MODEL_MARKS[place % len(MODEL_MARKS)])
    for place, name in enumerate(dict.fromkeys([*MODELS, *QUANTILE_MODELS, *ENSEMBLES]))
}

#: Smaller errors (mm) are drawn here on a logarithmic axis: some models repeat their training rows exactly.
LEAST_MM = 1e-9
#: Inches: the text of a figure this wide keeps its size on a page.
PAGE = 7.2

#: dict[Any, Any] because matplotlib lists the name of every setting in its type.
SETTINGS: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.titley": 1.0,  # else matplotlib measures the axes in each draw, in case something stands above them
    "axes.labelsize": 9,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "svg.fonttype": "none",
    "svg.hashsalt": "softkin",
}


def blank(width: float, height: float) -> Figure:
    """An empty figure of `width` x `height` inches; it needs no window system."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(SETTINGS):
        return Figure(figsize=(width, height), layout="constrained")


def panels(n_rows: int, n_columns: int, width: float, height: float, **options: Any) -> tuple[Figure, list[list[Axes]]]:
    """A figure of `width` x `height` inches and its axes, row by row."""
    import matplotlib as mpl

    figure = blank(width, height)
    with mpl.rc_context(SETTINGS):
        axes = figure.subplots(n_rows, n_columns, squeeze=False, **options)
    return figure, [list(row) for row in axes]


def heading(
    figure: Figure,
    results: DatasetResults,
    text: str,
    shows: Collection[str] = (TEST, EXTRAPOLATION),
    *,
    rows_of: Collection[str] = (),
) -> None:
    """Write a title above all panels, and below it the notes of the subsets that it `shows`, such as a leak.

    `rows_of`: the subsets whose single rows are drawn; it is said when that is a sample of them.
    """
    width = int(12 * figure.get_figwidth())
    notes = [f"{subset}: {figure_text(note)}" for subset, note in results.notes.items() if subset in shows]
    notes += sample_notes(results, rows_of)
    lines = [fill(line, width) for line in (f"{figure_text(results.title)}: {text}", *notes)]
    figure.suptitle("\n".join(lines), fontsize=9 if notes else 10)


def logarithmic(axis: Axis, most_numbers: int = 8) -> None:
    """Put plain numbers on a logarithmic axis after everything is drawn: more per decade where decades are few."""
    from matplotlib.ticker import FormatStrFormatter, LogFormatterSciNotation, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    decades = np.log10(high / low)
    subs = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0) if decades < 1 else (1.0, 2.0, 5.0) if decades < 2 else (1.0,)
    axis.set_major_locator(LogLocator(subs=subs, numticks=most_numbers))
    plain = decades < 5 and low > 1e-4
    axis.set_major_formatter(FormatStrFormatter("%g") if plain else LogFormatterSciNotation())
    axis.set_minor_formatter(NullFormatter())


def legend_below(figure: Figure, handles: Iterable[Any], n_columns: int) -> None:
    """Draw one legend for all panels, below them."""
    figure.legend(handles=list(handles), loc="outside lower center", ncols=n_columns, frameon=False)


def sample(label: str, **look: Any) -> Line2D:
    """A line or mark for a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], label=label, **look)


def model_samples(models: Iterable[str], results: DatasetResults) -> list[Line2D]:
    """Legend entries of models, in their order."""
    return [
        sample(results.model_titles[name], color=LOOKS[name][0], marker=LOOKS[name][1], linestyle="", markersize=5)
        for name in models
    ]
