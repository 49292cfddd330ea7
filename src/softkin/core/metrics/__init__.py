"""Metrics of predicted positions (`point`), quantiles (`pinball`) and intervals (`interval`)."""
