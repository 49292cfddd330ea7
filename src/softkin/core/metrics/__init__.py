"""Metrics: of predicted positions (point), later of intervals."""
