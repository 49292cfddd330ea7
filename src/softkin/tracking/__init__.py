"""Log result files to MLflow: runs, figures and registered models. No other package imports mlflow."""

from __future__ import annotations

import os

# Told before any module imports MLflow.
os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")
os.environ.setdefault("MLFLOW_ENABLE_ARTIFACTS_PROGRESS_BAR", "false")
# A server that dies is given up after a quarter of a minute; by default MLflow tries it for four minutes and more.
os.environ.setdefault("MLFLOW_HTTP_REQUEST_MAX_RETRIES", "3")
os.environ.setdefault("MLFLOW_HTTP_REQUEST_TIMEOUT", "60")
