"""Registries of figures: one file a figure (frame and plot), one line here, in the order of the report."""

from __future__ import annotations

from softkin.reporting.figures import (
    calibration,
    conditional_coverage,
    distance,
    distribution,
    extrapolation,
    importance,
    intervals,
    learning_curve,
    position_curves,
    published,
    ranking,
    residuals,
    robot,
    target_spaces,
    time,
    tuning_history,
    width,
    workspace,
    workspace_predictions,
)
from softkin.reporting.figures.spec import CampaignResults, DatasetResults, FigureSpec

#: Of one dataset.
FIGURES: dict[str, FigureSpec[DatasetResults]] = {
    "ranking": ranking.FIGURE,
    "robot": robot.FIGURE,
    "workspace_predictions": workspace_predictions.FIGURE,
    "position_curves": position_curves.FIGURE,
    "distribution": distribution.FIGURE,
    "distance": distance.FIGURE,
    "workspace": workspace.FIGURE,
    "residuals": residuals.FIGURE,
    "time": time.FIGURE,
    "intervals_paper": intervals.PAPER_RECIPE,
    "intervals_deployed": intervals.DEPLOYED_MODEL,
    "calibration": calibration.FIGURE,
    "width": width.FIGURE,
    "conditional_coverage": conditional_coverage.FIGURE,
    "extrapolation": extrapolation.FIGURE,
    "target_spaces": target_spaces.FIGURE,
    "tuning_history": tuning_history.FIGURE,
    "importance": importance.FIGURE,
}

#: Across datasets.
CAMPAIGN_FIGURES: dict[str, FigureSpec[CampaignResults]] = {
    "published": published.FIGURE,
    "learning_curve": learning_curve.FIGURE,
}
