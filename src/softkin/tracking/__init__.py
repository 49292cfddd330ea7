"""Log result files to MLflow: runs, figures and registered models. No other package imports mlflow."""

from __future__ import annotations

from softkin.tracking.champion import log_champion
from softkin.tracking.intervals import log_intervals
from softkin.tracking.lock import locked
from softkin.tracking.models import log_dataset
from softkin.tracking.orientation import log_orientation
from softkin.tracking.store import Campaign, create_store

__all__ = ["Campaign", "create_store", "locked", "log_champion", "log_dataset", "log_intervals", "log_orientation"]
