"""The robot in time: residuals in the order of the recording, and the loop that a command leaves behind."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.samples import EXTRAPOLATION, SUBSETS, TRAIN, Array, coordinate_columns
from softkin.core.time_residuals import TimeResiduals, time_residuals
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import deployed, predicted
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import (
    BLUE,
    GREEN,
    GREY,
    LIGHT,
    MODEL_COLOURS,
    ORANGE,
    PAGE,
    PURPLE,
    SKY,
    VERMILION,
    blank,
    heading,
    legend_below,
    sample,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SESSION_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, SKY)
UP, DOWN = VERMILION, MODEL_COLOURS[1]
#: Rows of the running mean, bins of a loop, and rows of a bin at least.
RUNNING, N_BINS, LEAST = 25, 7, 5


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, coordinate, order, session, static_mm, zero_mm, command, command_name,
    comes_from, subset, deployed_mm: a row per pose of the recording and each of the two coordinates whose residuals
    of a smooth fit by commands alone scatter most.

    `zero_mm` is the mean of the session. `command` is the one whose direction of approach, `comes_from` (below, above),
    matters most to the coordinate. `deployed_mm` is measured minus predicted by the deployed run, missing on `train`,
    which it was fitted to.
    """
    samples = {subset: read_subset(results.table, subset) for subset in SUBSETS}
    known, best = time_residuals(samples), deployed(results)
    if known is None or best is None:
        return pd.DataFrame()
    left = known.without_zeros()
    columns = coordinate_columns(samples[TRAIN].positions.shape[1] // 3)
    errors = pd.concat(
        pd.DataFrame(rows.positions - predicted(results, best.run, subset, columns), rows.recording.order, columns)
        for subset, rows in samples.items()
        if subset != TRAIN and rows.recording is not None
    )
    subset_of = pd.concat(
        pd.Series(subset, rows.recording.order) for subset, rows in samples.items() if rows.recording is not None
    )
    shown = np.argsort(-known.residuals.std(axis=0), kind="stable")[:2]
    frames = []
    for place in sorted(shown):
        command = _most_felt(known, left[:, place])
        frames.append(
            pd.DataFrame(
                {
                    "coordinate": known.names[place],
                    "order": known.order,
                    "session": known.session,
                    "static_mm": known.residuals[:, place],
                    "zero_mm": (known.residuals - left)[:, place],
                    "command": known.commands[:, command],
                    "command_name": f"u{command + 1}",
                    "comes_from": np.where(known.step[:, command] > 0, "below", "above"),
                    "subset": subset_of.reindex(known.order).to_numpy(),
                    "deployed_mm": errors[known.names[place]].reindex(known.order).to_numpy(),
                }
            )
        )
    return pd.concat(frames, ignore_index=True).assign(model=best.model, preset=best.preset, interval_method="")


def _most_felt(known: TimeResiduals, residual: Array) -> int:
    """The command whose direction of approach parts the residuals (n_rows,) most."""
    gaps = [abs(residual[step > 0].mean() - residual[step <= 0].mean()) for step in known.step.T]
    return int(np.argmax(gaps))


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw the recording of each coordinate above its loops: of a fit by commands alone, and of the deployed model."""
    figure = blank(PAGE, 6.4)
    coordinates = list(frame["coordinate"].unique())
    grid = figure.add_gridspec(len(coordinates) + 1, 2, height_ratios=[*[1.0] * len(coordinates), 1.45])
    for place, name in enumerate(coordinates):
        axes = figure.add_subplot(grid[place, :])
        _draw_recording(axes, frame[frame["coordinate"] == name], results.unit)
        axes.set_ylabel(f"{name} ({results.unit})")
        if place < len(coordinates) - 1:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel("pose, in the order in which they were recorded")
    worst = max(coordinates, key=lambda name: _gap(frame[frame["coordinate"] == name]))
    rows = frame[frame["coordinate"] == worst]
    loops = [figure.add_subplot(grid[-1, place]) for place in range(2)]
    first = rows.iloc[0]
    title = f"{results.model_titles[first['model']]}, {first['preset']}, on rows it was not fitted to"
    reach = 1.1 * max(_extreme(rows, name) for name in ("static", "deployed"))
    for axes, name, text in zip(loops, ("static", "deployed"), ("a fit by commands alone", title), strict=True):
        _draw_loop(axes, rows, name, results.unit)
        axes.set_ylim(-reach, reach)
        axes.set_title(text, fontsize=8)
        axes.set_xlabel(f"command {first['command_name']}")
    loops[0].set_ylabel(f"measured - predicted\n{worst}, less its zero ({results.unit})")
    samples = [
        sample(f"session {number}", color=_colour(number), marker="o", markersize=4, linewidth=2)
        for number in frame["session"].unique()
    ]
    samples += [
        sample("comes from below", color=UP, marker=">", markersize=5),
        sample("comes from above", color=DOWN, marker="<", markersize=5),
    ]
    legend_below(figure, samples, len(samples))
    heading(figure, results, "what the robot remembers", ())
    return figure


def _colour(session: int) -> str:
    return SESSION_COLOURS[(session - 1) % len(SESSION_COLOURS)]


def _draw_recording(axes: Axes, rows: pd.DataFrame, unit: str) -> None:
    """Residuals as dots, their running mean as a line, the zero of each session as a step."""
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for number, part in rows.groupby("session"):
        colour = _colour(int(str(number)))
        axes.plot(part["order"], part["static_mm"], ".", color=colour, markersize=2.2, alpha=0.35, rasterized=True)
        running = part["static_mm"].rolling(RUNNING, center=True, min_periods=RUNNING // 2).mean()
        axes.plot(part["order"], running, color=colour, linewidth=1.4)
        ends = [part["order"].min(), part["order"].max()]
        zero = part["zero_mm"].iloc[0]
        axes.plot(ends, [zero, zero], color="black", linewidth=1.2, linestyle=(0, (4, 2)))
        if ends[0] > rows["order"].min():
            axes.axvline(ends[0] - 0.5, color=GREY, linewidth=0.8)
        text = f"zero {zero:+.1f} {unit}".replace("-", "\N{MINUS SIGN}")
        axes.text(
            float(np.mean(ends)), 0.97, text, transform=axes.get_xaxis_transform(), ha="center", va="top", fontsize=7.5,
            color=colour, bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
        )  # fmt: skip
    limit = float(np.quantile(np.abs(rows["static_mm"]), 0.998)) * 1.35
    axes.set_ylim(-limit, limit)
    axes.set_xlim(rows["order"].min() - 1, rows["order"].max() + 1)
    axes.grid(visible=False, axis="x")


def _branches(rows: pd.DataFrame, name: str) -> pd.DataFrame:
    """Mean residual (mm) of bins of the command, by where the robot comes from, in-domain; bins of few are left out."""
    values = rows["static_mm"] - rows["zero_mm"] if name == "static" else rows["deployed_mm"]
    known = rows.assign(value=values)[rows["subset"] != EXTRAPOLATION].dropna(subset=["value"])
    edges = np.quantile(rows.loc[rows["subset"] != EXTRAPOLATION, "command"], np.linspace(0, 1, N_BINS + 1))
    bins = np.clip(np.searchsorted(edges, known["command"], side="right") - 1, 0, N_BINS - 1)
    table = known.assign(bin=bins, centre=(edges[bins] + edges[bins + 1]) / 2).groupby(["comes_from", "bin"])
    means = table.agg(
        centre=("centre", "first"), value=("value", "mean"), spread=("value", "std"), n=("value", "size")
    ).reset_index()
    return means[means["n"] >= LEAST]


def _gap(rows: pd.DataFrame) -> float:
    """How far apart (mm) the branches of the fit by commands alone lie, in the mean."""
    wide = _branches(rows, "static").pivot_table(index="bin", columns="comes_from", values="value").dropna()
    return float((wide["below"] - wide["above"]).abs().mean()) if len(wide.columns) == 2 else 0.0


def _extreme(rows: pd.DataFrame, name: str) -> float:
    """The farthest (mm) that a branch and its standard error go."""
    means = _branches(rows, name)
    return float((means["value"].abs() + 2 * means["spread"].fillna(0) / np.sqrt(means["n"])).max())


def _draw_loop(axes: Axes, rows: pd.DataFrame, name: str, unit: str) -> None:
    """Both branches with two standard errors, what lies between them filled; the mean gap is written."""
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    means = _branches(rows, name)
    wide = means.pivot_table(index="centre", columns="comes_from", values="value").dropna()
    if len(wide.columns) == 2:
        axes.fill_between(wide.index, wide["below"], wide["above"], color=LIGHT, alpha=0.5, linewidth=0)
        gap = float((wide["below"] - wide["above"]).abs().mean())
        axes.text(0.97, 0.95, f"gap {gap:.2f} {unit}", transform=axes.transAxes, ha="right", va="top", fontsize=9)
    for side, colour, mark in (("below", UP, ">"), ("above", DOWN, "<")):
        of_side = means[means["comes_from"] == side]
        error = 2 * of_side["spread"] / np.sqrt(of_side["n"])
        axes.errorbar(
            of_side["centre"], of_side["value"], error, color=colour, marker=mark, markersize=5, linewidth=1.6,
            elinewidth=0.8,
        )  # fmt: skip


FIGURE = FigureSpec(
    "time",
    "The robot in time",
    "Above, what a smooth fit by commands alone leaves, pose by pose in the order of the recording, with its running "
    "mean; dashed is the zero of each session. A robot without memory scatters evenly about one line: steps between "
    "sessions are zeros, waves are memory or drift. Below, the same less its zero, by the command and by the side that "
    "the robot comes from, in-domain: where the branches part it remembers, and no model of the command alone can tell "
    "them apart. "
    "On the right what the deployed model leaves of rows that it was not fitted to: one with memory closes the loop.",
    frame,
    plot,
)
