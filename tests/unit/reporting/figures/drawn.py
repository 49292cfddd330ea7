"""What a panel shows, read back as numbers."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle


def xs(line: Line2D) -> list[float]:
    """Positions of a line's points across."""
    return [float(x) for x in np.asarray(line.get_xdata(), dtype=float)]


def ys(line: Line2D) -> list[float]:
    """Positions of a line's points up."""
    return [float(y) for y in np.asarray(line.get_ydata(), dtype=float)]


def marks(axes: Axes) -> list[Line2D]:
    """Lines of one point."""
    return [line for line in axes.lines if len(xs(line)) == 1]


def bars(axes: Axes) -> list[tuple[float, float]]:
    """Left and right end of each bar."""
    drawn = [patch for patch in axes.patches if isinstance(patch, Rectangle)]
    return [(float(bar.get_x()), float(bar.get_x() + bar.get_width())) for bar in drawn]
