"""A clean robot: constant-curvature sections, smooth, with a little noise; split as the published datasets are."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, VALIDATION, Array, Samples


def poses(commands: Array, n_markers: int, seed: int) -> Array:
    """Markers (n_rows, 3 * n_markers) in mm at the ends of sections 100 mm long, each bent by two commands (the last by
    one where their number is odd); the base is turned at random, so that no coordinate stands still.
    """
    n_rows, n_commands = commands.shape
    n_sections = max(n_markers, (n_commands + 1) // 2)
    bends = np.zeros((n_rows, 2 * n_sections))
    bends[:, :n_commands] = commands
    turned = Rotation.concatenate([Rotation.random(rng=np.random.default_rng(seed))] * n_rows)
    tip = np.zeros((n_rows, 3))
    tips = []
    for x, y in bends.reshape(n_rows, n_sections, 2).transpose(1, 2, 0):
        angle = np.hypot(x, y)
        out, up = np.sinc(angle / (2 * np.pi)) ** 2 / 2, np.sinc(angle / np.pi)
        tip = tip + turned.apply(100 * np.column_stack([x * out, y * out, up]))
        turned = turned * Rotation.from_rotvec(np.column_stack([-y, x, 0 * x]))
        tips.append(tip)
    shown = np.linspace(n_sections - 1, 0, n_markers).round().astype(int)[::-1]
    return np.hstack([tips[section] for section in shown])


def clean_robot(
    n_rows: int, n_commands: int = 2, n_markers: int = 1, noise_mm: float = 0.1, seed: int = 0
) -> dict[str, Samples]:
    """The outer 30 % by command norm is extrapolation, the rest is 80/10/10 train, validation and test."""
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-1, 1, (n_rows, n_commands))
    if n_commands > 6:  # many small bends, or the arm ties itself in knots
        commands /= np.sqrt(n_commands)
    positions = poses(commands, n_markers, seed)
    positions += noise_mm * rng.standard_normal(positions.shape)
    order = np.argsort(np.linalg.norm(commands, axis=1), kind="stable")
    inner = rng.permutation(order[: round(0.7 * n_rows)])
    train, rest = np.split(inner, [round(0.8 * len(inner))])
    validation, test = np.split(rest, [len(rest) // 2])
    parts = {TRAIN: train, VALIDATION: validation, TEST: test, EXTRAPOLATION: order[round(0.7 * n_rows) :]}
    return {subset: Samples(commands[rows], positions[rows]) for subset, rows in parts.items()}
