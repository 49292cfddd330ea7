"""What the paper calls its models by, where it speaks of more than one or of one alone: its Table 1."""

from __future__ import annotations

LINEAR = ("lr", "lasso")
FOREST = "rf"
BOOSTED = ("gb", "xgb")
KERNEL = ("svr", "gp")
PROCESS = "gp"
NETWORK = "mlp"
#: The plain linear model, and the one whose penalty sets coefficients to zero.
PLAIN_LINEAR, PENALISED = LINEAR
CATEGORIES = {"linear": LINEAR, "ensemble": (FOREST, *BOOSTED), "kernel": KERNEL, "network": (NETWORK,)}
#: One nonlinear model of each kind, the quickest to fit: their learning curves tell which kind needs most data.
ONE_OF_EACH_KIND = (FOREST, "xgb", "svr", NETWORK)
ALL = tuple(model for models in CATEGORIES.values() for model in models)
