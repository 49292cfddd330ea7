"""Static equilibrium of a Cosserat rod, for many load cases at once. Units: mm, N, MPa.

A boundary-value problem (the equations and their sources are in `cosserat_equations`): clamped at the base, given force
and moment at the tip. Solved by shooting. Dead loads give the force everywhere, so the three components of the moment
at the base are all that is unknown; Newton's method finds them for all rows together. Each solution is then tested for
stability by Jacobi's condition, as in Till and Rucker (2017), "Elastic stability of Cosserat rods and parallel
continuum robots", IEEE Trans. Robotics 33(3): a loaded rod can have many equilibria, and a robot is found in a stable
one.
"""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import ConfigError
from softkin.core.samples import Array
from softkin.data.standins.cosserat_equations import M, N, Q, R, base_states, cross, march
from softkin.data.standins.rod import Loads, Rod, Shape

logger = logging.getLogger("softkin")

#: The largest tip moment left over, as a share of (smallest) bending stiffness / length.
TOLERANCE = 1e-9
NEWTON_STEPS = 12
#: Rows that are not solved from the unloaded rod in one step are loaded in so many steps, then in more.
LOAD_STEPS = (1, 4, 16, 64)
#: Rows solved together: large enough for numpy, small enough for the processor's cache.
BATCH = 512
#: Difference quotients: of moments as a share of stiffness / length, and of rotations in rad.
NUDGE = 1e-6


def solve(
    rod: Rod, loads: Loads, *, n_elements: int = 24, base_rotation: Array | None = None, label: str = "rod"
) -> Shape:
    """Stable equilibrium shapes of `rod`, clamped at the origin, under each row of `loads`.

    The error in a position falls with the fourth power of `n_elements`.

    Parameters:
        rod: the rod.
        loads: its loads, one row per shape.
        n_elements: steps of integration from base to tip.
        base_rotation: (3, 3), turns the rod's axes at the base into global axes; None leaves them as they are.
        label: starts the lines of progress in the log.

    Raises:
        ConfigError: a row has no stable equilibrium; names the row and its loads.
    """
    from scipy.spatial.transform import Rotation

    turn = Rotation.identity() if base_rotation is None else Rotation.from_matrix(base_rotation)
    quaternion = turn.as_quat(scalar_first=True)
    shapes = []
    for start in range(0, len(loads), BATCH):
        batch = loads.rows(slice(start, start + BATCH))
        states = _equilibria(rod, batch, quaternion, n_elements, start)
        shapes.append(np.moveaxis(states, -1, 0))  # (n_rows, n_stations, n_state)
        if len(loads) > BATCH:
            logger.info("%s: %d of %d rows simulated", label, min(start + BATCH, len(loads)), len(loads))
    stations = np.concatenate(shapes)
    quaternions = stations[..., Q] / np.linalg.norm(stations[..., Q], axis=-1, keepdims=True)
    return Shape(stations[..., R], quaternions, stations[..., N], stations[..., M])


def _equilibria(rod: Rod, loads: Loads, quaternion: Array, n_elements: int, first_row: int) -> Array:
    """States (n_stations, n_state, n_rows), from the base to the tip."""
    solution = np.empty((n_elements + 1, 13 + len(rod.tendons), len(loads)))
    left = np.arange(len(loads))
    for n_steps in LOAD_STEPS:
        rows, guess = left, np.zeros((3, len(left)))
        for step in range(1, n_steps + 1):
            guess, solved = _newton(rod, loads.rows(rows).scaled(step / n_steps), quaternion, guess, n_elements)
            rows, guess = rows[solved], guess[:, solved]
        here = loads.rows(rows)
        states = march(rod, here, base_states(rod, here, quaternion, guess), rod.length / n_elements, n_elements)
        stable = _stable(rod, here, states)
        solution[..., rows[stable]] = np.stack(states)[..., stable]
        left = np.setdiff1d(left, rows[stable])
        if not left.size:
            return solution
    row = loads.rows(left[:1])
    carried = ", ".join(f"{name} {getattr(row, name)[0].round(6).tolist()}" for name in Loads.__slots__)
    raise ConfigError(
        f"no stable equilibrium ({len(left)} of {len(loads)} rows of its batch have none)\n  loads: {carried}",
        where=f"rod, row {first_row + left[0]}",
        fix=f"make the loads smaller or the rod stiffer or shorter (it may buckle), or take more elements than "
        f"{n_elements}",
    )


def _newton(
    rod: Rod, loads: Loads, quaternion: Array, start: Array, n_elements: int
) -> tuple[Array, NDArray[np.bool_]]:
    """Newton's method on the tip moment from `start` (3, n_rows); the moments, and which rows are solved."""
    scale = max(rod.bend_stiffness) / rod.length
    moments, solved = start.copy(), np.zeros(len(loads), dtype=bool)
    active = np.arange(len(loads))
    for _ in range(NEWTON_STEPS):
        n, here = active.size, loads.rows(np.tile(active, 4))
        shots = np.tile(moments[:, active], 4)
        for axis in range(3):
            shots[axis, (axis + 1) * n : (axis + 2) * n] += NUDGE * scale
        with np.errstate(all="ignore"):  # a row that diverges becomes nan, and is left unsolved
            base = base_states(rod, here, quaternion, shots)
            tip = march(rod, here, base, rod.length / n_elements, n_elements)[-1][M] - here.tip_moment.T
            shot = tip.reshape(3, 4, n)
            miss = shot[:, 0]
            slopes = np.moveaxis(shot[:, 1:] - miss[:, None], -1, 0) / (NUDGE * scale)  # (n, of tip, by base)
            determinants = np.linalg.det(slopes)
        hit = np.abs(miss).max(axis=0) <= TOLERANCE * min(rod.bend_stiffness) / rod.length
        solved[active[hit]] = True
        go_on = ~hit & np.isfinite(determinants) & (determinants != 0)
        active = active[go_on]
        if not active.size:
            break
        step = np.linalg.solve(slopes[go_on], -miss[:, go_on].T[..., None])[..., 0].T
        # Beyond about one radian the tangent says little: the step is cut there.
        moments[:, active] += step / np.maximum(1.0, np.abs(step).max(axis=0) / scale)
    return moments, solved


def _stable(rod: Rod, loads: Loads, states: list[Array]) -> NDArray[np.bool_]:
    """Which equilibria are minima of energy: Jacobi's condition (friction is taken as if it were a load).

    Small rotations of the tip, carried along the rod to its base, stay linearly independent at every section. They are
    followed from station to station: an eigenvalue of their change is near 1, and negative behind a conjugate point.
    """
    n = len(loads)
    tips = np.tile(states[-1], 4)
    w, x, y, z = states[-1][Q]
    for axis, turned in enumerate([(-x, w, -z, y), (-y, z, w, -x), (-z, -y, x, w)], start=1):
        tips[Q, axis * n : (axis + 1) * n] += (NUDGE / 2) * np.stack(turned)
    n_elements = len(states) - 1
    back = march(rod, loads.rows(np.tile(np.arange(n), 4)), tips, -rod.length / n_elements, n_elements)
    fields = []
    for state in back:
        turned_q = state[Q].reshape(4, 4, n)
        scalar, vector = turned_q[0], turned_q[1:]
        own, own_scalar = vector[:, :1], scalar[0]
        turns = own_scalar * vector[:, 1:] - scalar[1:] * own - cross(vector[:, 1:], own)
        fields.append(np.moveaxis(turns, -1, 0) * (2 / NUDGE))
    field = np.stack(fields, axis=1)  # (n, n_stations, global axis, turned tip)
    # A sign that changes is a conjugate point; a field that is singular at a station cannot be inverted below.
    stable = (np.linalg.det(field) > 0).all(axis=1)
    changes = field[stable, 1:] @ np.linalg.inv(field[stable, :-1])
    stable[stable] = (np.linalg.eigvals(changes).real > 0).all(axis=(1, 2))
    return np.asarray(stable)
