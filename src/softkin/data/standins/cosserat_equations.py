"""The equations of a static Cosserat rod, for many load cases at once. Units: mm, N, MPa.

Along the reference arc length s, with position r, rotation R, internal force n and moment m of the whole section:

    r' = R v,   R' = R [u]x,   n' = -f,   m' = -r' x n,          r, R given at the base; n, m given at the tip
    K_se (v - e3) = R^T n - sum_i T_i t_i + sum_j p_j A e3
    K_bt (u - u0) = R^T m - sum_i d_i x T_i t_i + sum_j d_j x p_j A e3,        t_i = (v + u x d_i) / |v + u x d_i|

Tendons (tension T_i, tangent t_i in the rod's axes, offset d_i) pull along their own path: the model of Rucker and
Webster (2011), "Statics and dynamics of continuum robots with general tendon routing and external loading", IEEE
Trans. Robotics 27(6). They write the tendon's push on the rod as a distributed load, which needs v' and u'; counting
the tendon's tension to the section's force instead gives the same equilibrium without derivatives. Chambers push on
their end caps along the section's normal: the fluidic case of Till, Aloi and Rucker (2019), "Real-time dynamics of soft
and continuum robots based on Cosserat rod models", Int. J. Robotics Research 38(6).

Friction: along a tendon, T_i' = -slide_i * mu * T_i * |u x t_i| (capstan equation; exact for untwisted parallel paths).
"""

from __future__ import annotations

import numpy as np

from softkin.core.samples import Array
from softkin.data.standins.rod import Loads, Rod

#: Rows of the state: r, quaternion (scalar first), n, m, then one tension per tendon.
R, Q, N, M, T = slice(0, 3), slice(3, 7), slice(7, 10), slice(10, 13), slice(13, None)


def base_states(rod: Rod, loads: Loads, quaternion: Array, base_moments: Array) -> Array:
    """States (n_state, n_rows) at the base, at the origin, turned by `quaternion` (4,), under moments (3, n_rows)."""
    state = np.zeros((13 + len(rod.tendons), len(loads)))
    state[Q] = quaternion[:, None]
    state[N] = (loads.tip_force + rod.length * loads.distributed_force).T
    state[M] = base_moments
    state[T] = loads.tensions.T
    return state


def march(rod: Rod, loads: Loads, state: Array, step: float, n_steps: int) -> list[Array]:
    """The states (n_state, n_rows) along the rod, integrated by the classical Runge-Kutta method of order 4.

    Parameters:
        rod: the rod.
        loads: its loads, n_rows of them.
        state: where integration starts, (n_state, n_rows); the first of the result.
        step: distance of two states in mm; negative towards the base.
        n_steps: number of states after the first.
    """
    rates = _Rates(rod, loads)
    states = [state]
    for _ in range(n_steps):
        k1 = rates(state)
        k2 = rates(state + (step / 2) * k1)
        k3 = rates(state + (step / 2) * k2)
        k4 = rates(state + step * k3)
        state = state + (step / 6) * (k1 + 2 * (k2 + k3) + k4)
        states.append(state)
    return states


class _Rates:
    """The derivative of the state by s. Keeps the tendons' last tangents, from which the next ones are iterated."""

    def __init__(self, rod: Rod, loads: Loads) -> None:
        self.rod = rod
        self.force_along = -loads.distributed_force.T
        self.slides = loads.slides.T
        pushes = rod.chamber_area * loads.pressures.T
        offsets = np.array(rod.chambers, dtype=np.float64).reshape(-1, 2)
        self.push = np.stack([np.zeros(len(loads)), np.zeros(len(loads)), pushes.sum(axis=0)])
        turn = [np.einsum("c,cn->n", offsets[:, 1], pushes), -np.einsum("c,cn->n", offsets[:, 0], pushes)]
        self.turn = np.stack([*turn, np.zeros(len(loads))])
        self.x, self.y = np.array(rod.tendons, dtype=np.float64).reshape(-1, 2).T[..., None]
        tangents = np.zeros((3, len(rod.tendons), len(loads)))
        tangents[2] = 1.0
        self.tangents = tangents
        self.stretch = np.array(rod.stretch_stiffness)[:, None]
        self.bend = np.array(rod.bend_stiffness)[:, None]
        self.natural = np.array(rod.natural_curvature)[:, None]

    def __call__(self, state: Array) -> Array:
        rotation = _matrix(state[Q])
        force = np.einsum("ijn,in->jn", rotation, state[N])
        moment = np.einsum("ijn,in->jn", rotation, state[M])
        v, u = self._strains(force + self.push, moment + self.turn, state[T])
        rates = np.empty_like(state)
        rates[R] = np.einsum("ijn,jn->in", rotation, v)
        w, x, y, z = state[Q]
        rates[3] = -0.5 * (x * u[0] + y * u[1] + z * u[2])
        rates[4] = 0.5 * (w * u[0] + y * u[2] - z * u[1])
        rates[5] = 0.5 * (w * u[1] + z * u[0] - x * u[2])
        rates[6] = 0.5 * (w * u[2] + x * u[1] - y * u[0])
        rates[N] = self.force_along
        rates[M] = -cross(rates[R], state[N])
        if self.rod.friction:
            bend = np.sqrt((cross(u[:, None], self.tangents) ** 2).sum(axis=0))
            rates[T] = -self.rod.friction * self.slides * state[T] * bend
        else:
            rates[T] = 0.0
        return rates

    def _strains(self, force: Array, moment: Array, tensions: Array) -> tuple[Array, Array]:
        """Strains v and u (3, n_rows), consistent with the tendons' tangents: a fixed point, reached by iteration.

        Each turn contracts by about tension * offset**2 / torsional stiffness.
        """
        for _ in range(60):
            pull = tensions * self.tangents
            v = (force - pull.sum(axis=1)) / self.stretch
            v[2] += 1.0
            turn = [self.y * pull[2], -self.x * pull[2], self.x * pull[1] - self.y * pull[0]]
            u = self.natural + (moment - np.stack([part.sum(axis=0) for part in turn])) / self.bend
            if not tensions.size:
                return v, u
            along = np.stack(
                [v[0] - self.y * u[2], v[1] + self.x * u[2], v[2] + self.y * u[0] - self.x * u[1]]
            )  # (3, n_tendons, n_rows)
            tangents = along / np.sqrt((along**2).sum(axis=0))
            moving = (np.abs(tangents - self.tangents) > 1e-12).any(axis=(0, 1))
            self.tangents = tangents
            if not moving.any():
                return v, u
        v[:, moving] = np.nan  # no fixed point: such a row is left unsolved
        return v, u


def cross(a: Array, b: Array) -> Array:
    """Cross product along the first axis."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _matrix(quaternion: Array) -> Array:
    """Rotation matrices (3, 3, n) of quaternions (4, n) of any length but zero."""
    w, x, y, z = quaternion / np.sqrt((quaternion**2).sum(axis=0))
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
