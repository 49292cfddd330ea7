"""Heat map of softkin's metrics divided by the paper's printed ones, cell by cell, across datasets."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.escaping import figure_text
from softkin.core.runs import PRESETS
from softkin.reporting.figures.spec import CampaignResults, FigureSpec
from softkin.reporting.figures.style import BLACK, PAGE, panels
from softkin.reporting.tables.verdicts import REPRODUCED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

METRICS = {"rmse_mm": "RMSE", "mae_mm": "MAE", "r2": "1 - R2", "mape_percent": "MAPE"}
#: Text of a cell that is reproduced to the last printed digit.
SAME = "="
#: Colours end at this ratio and at its inverse.
LIMIT = 8.0


def frame(results: CampaignResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, dataset, subset, metric, printed, value, ratio, verdict, note: a row per
    printed cell and preset. `ratio` is softkin's metric divided by the printed one, for R2 that of 1 - R2: below 1 is
    better.
    """
    cells = read_csv(results.published_comparison, dtype={"note": str}).fillna({"note": ""})
    parts = []
    for preset in (preset for preset in PRESETS if f"{preset}_value" in cells):
        part = cells[["dataset", "subset", "model", "metric", "printed", "note"]].copy()
        part["value"], part["verdict"] = pd.to_numeric(cells[f"{preset}_value"]), cells[f"{preset}_verdict"]
        part["printed"] = pd.to_numeric(part["printed"])
        of_r2 = part["metric"] == "r2"
        measured = part["value"].where(~of_r2, 1 - part["value"])
        printed = part["printed"].where(~of_r2, 1 - part["printed"])
        parts.append(part.assign(preset=preset, interval_method="", ratio=measured / printed.where(printed > 0)))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def plot(frame: pd.DataFrame, results: CampaignResults) -> Figure:
    """Draw a row of panels for each dataset, a column for each preset."""
    from matplotlib.colors import LogNorm

    datasets, presets = list(frame["dataset"].unique()), list(frame["preset"].unique())
    models = [name for name in results.model_titles if name in set(frame["model"])]
    noted = frame[frame["note"] != ""].groupby(["dataset", "note"], sort=False)["subset"]
    notes = {key: " and ".join(subsets.unique()) for key, subsets in noted}
    height = 1.3 + len(datasets) * (0.6 + 0.24 * len(models)) + 0.3 * len(notes)
    figure, axes = panels(len(datasets), len(presets), PAGE, height, sharey=True)
    norm = LogNorm(1 / LIMIT, LIMIT)
    for row, dataset in enumerate(datasets):
        for column, preset in enumerate(presets):
            cells = frame[(frame["dataset"] == dataset) & (frame["preset"] == preset)]
            image = _draw(axes[row][column], cells, models, norm)
            name = figure_text(results.dataset_titles[dataset].split(" (")[0])
            name += "*" if (cells["note"] != "").any() else ""
            axes[row][column].set_title(f"{name}, {preset} preset", pad=14)
        axes[row][0].set_yticks(range(len(models)), [results.model_titles[model] for model in models])
    figure.colorbar(
        image,
        ax=[axis for line in axes for axis in line],
        location="bottom",
        shrink=0.6,
        aspect=40,
        pad=0.02,
        label=f"softkin / printed (below 1 softkin is better; {SAME} reproduced)",
        ticks=[1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8],
        format="%g",
        extend="both",
    ).minorticks_off()
    lines = [fill(f"* {dataset}, {subsets}: {note}", 100) for (dataset, note), subsets in notes.items()]
    figure.suptitle(
        "\n".join(["softkin's metrics against the paper's Tables 3 to 5, cell by cell", *lines]), fontsize=8.5
    )
    return figure


def _draw(axes: Axes, cells: pd.DataFrame, models: list[str], norm: Any) -> Any:
    columns = [(s, m) for s in cells["subset"].unique() for m in METRICS]
    table = cells.set_index(["model", "subset", "metric"])
    ratios = np.array([[table["ratio"].get((model, *column), np.nan) for column in columns] for model in models])
    shown = np.clip(ratios, 1 / LIMIT**2, LIMIT**2)
    image = axes.imshow(shown, norm=norm, cmap="PuOr_r", aspect="auto")
    for (row, column), ratio in np.ndenumerate(ratios):
        if np.isfinite(ratio):
            verdict = table.loc[(models[row], *columns[column]), "verdict"]
            is_dark = abs(np.log(shown[row, column])) > np.log(LIMIT) * 0.7
            text = SAME if verdict == REPRODUCED else _short(ratio)
            colour = "white" if is_dark else BLACK
            axes.text(column, row, text, ha="center", va="center", fontsize=5.5, color=colour)
    axes.set_xticks(range(len(columns)), [METRICS[metric] for _, metric in columns], fontsize=6.5, rotation=90)
    for place, subset in enumerate(dict.fromkeys(subset for subset, _ in columns)):
        axes.text(4 * place + 1.5, -0.6, subset, ha="center", va="bottom", fontsize=8)
    axes.grid(visible=False)
    axes.axvline(3.5, color="white", linewidth=2)
    return image


def _short(ratio: float) -> str:
    """The ratio in at most three characters: '1.0', '.31', '48', '0'."""
    if ratio < 0.01:
        return "0"
    if ratio >= 999:
        return "999"
    return f"{ratio:.2f}".lstrip("0") if round(ratio, 2) < 1 else f"{ratio:.1f}" if ratio < 9.95 else f"{ratio:.0f}"


FIGURE = FigureSpec(
    "published",
    "The paper's tables, reproduced",
    "softkin's metric divided by the printed one for every cell of the paper's Tables 3 to 5, with the paper's "
    "settings and with searched ones. With the paper's settings look for =, reproduced to the last printed digit. With "
    "searched settings a number below 1 is an error smaller than the printed one (0: below a hundredth of it). Where "
    "R2 is printed as nearly 1, the ratio of 1 - R2 is mostly that of its rounding.",
    frame,
    plot,
)
