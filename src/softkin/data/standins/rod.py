"""A Cosserat rod, its loads and its shape, as values. Units: mm, N, MPa (N/mm2), radians.

The rod's own axes: z along its centreline, x and y across. Its reference shape is straight along z unless it has a
`natural_curvature`. Global axes are those of the positions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import ConfigError
from softkin.core.samples import Array

Triple = tuple[float, float, float]
Rows = NDArray[np.intp]

STANDARD_GRAVITY = 9.80665e-3  # N of weight per gram


@dataclass(frozen=True, slots=True)
class Rod:
    """A clamped rod of one linear-elastic section.

    `length` in mm; `stretch_stiffness` (shear x, shear y, extension) in N; `bend_stiffness` (bending about x, about
    y, torsion) in N mm2; `natural_curvature` (3,) in rad/mm, the curvature without load; `mass_per_length` in g/mm.
    `tendons` and `chambers` are the offsets (x, y) in mm of channels that run parallel to the centreline;
    `chamber_area` in mm2; `friction` is Coulomb's coefficient between a tendon and its channel.
    """

    length: float
    stretch_stiffness: Triple
    bend_stiffness: Triple
    natural_curvature: Triple = (0.0, 0.0, 0.0)
    mass_per_length: float = 0.0
    tendons: tuple[tuple[float, float], ...] = ()
    chambers: tuple[tuple[float, float], ...] = ()
    chamber_area: float = 0.0
    friction: float = 0.0

    @property
    def weight_per_length(self) -> float:
        """Weight in N/mm under standard gravity."""
        return self.mass_per_length * STANDARD_GRAVITY


def section(
    young_modulus: float, area: float, second_moment: float, poisson_ratio: float = 0.5
) -> tuple[Triple, Triple]:
    """`stretch_stiffness` and `bend_stiffness` of a `Rod` with an axisymmetric section, in N and N mm2.

    (GA, GA, EA) and (EI, EI, 2GI), as in Rucker and Webster (2011), equation 5. `young_modulus` in MPa, `area` in
    mm2, `second_moment` of area in mm4.
    """
    shear_modulus = young_modulus / (2 * (1 + poisson_ratio))
    bending = young_modulus * second_moment
    stretching = (shear_modulus * area, shear_modulus * area, young_modulus * area)
    return stretching, (bending, bending, 2 * shear_modulus * second_moment)


def disc(radius: float) -> tuple[float, float]:
    """Area (mm2) and second moment of area about a diameter (mm4) of a full disc of `radius` mm."""
    return math.pi * radius**2, math.pi * radius**4 / 4


@dataclass(frozen=True, slots=True)
class Loads:
    """Loads of `n_rows` rods, a row each; make it with `loads`.

    `tip_force` (n_rows, 3) in N, `tip_moment` (n_rows, 3) in N mm and `distributed_force` (n_rows, 3) in N/mm of
    reference length are fixed in global axes. `tensions` (n_rows, n_tendons) in N are those at the base. `slides`
    (n_rows, n_tendons) from -1 to 1 says how far each tendon slides through its channel: 1 towards the base (it is
    being pulled, so friction takes tension away towards the tip), -1 towards the tip, 0 at rest without friction.
    `pressures` (n_rows, n_chambers) in MPa above ambient.
    """

    tip_force: Array
    tip_moment: Array
    distributed_force: Array
    tensions: Array
    slides: Array
    pressures: Array

    def __len__(self) -> int:
        return len(self.tip_force)

    def rows(self, index: Rows | slice) -> Loads:
        """The loads of some rows."""
        return Loads(*(getattr(self, name)[index] for name in self.__slots__))

    def scaled(self, factor: float) -> Loads:
        """All loads times `factor`; the tendons slide as before."""
        scaled = {name: getattr(self, name) * factor for name in self.__slots__}
        return Loads(**{**scaled, "slides": self.slides})


def loads(
    rod: Rod,
    n_rows: int,
    *,
    tip_force: Array | Sequence[float] = (0.0, 0.0, 0.0),
    tip_moment: Array | Sequence[float] = (0.0, 0.0, 0.0),
    distributed_force: Array | Sequence[float] = (0.0, 0.0, 0.0),
    tensions: Array | float = 0.0,
    slides: Array | float = 0.0,
    pressures: Array | float = 0.0,
) -> Loads:
    """Loads of `n_rows` rods, checked; each load is broadcast over the rows, and is zero where it is left out.

    Parameters:
        rod: whose tendons and chambers the loads are for.
        n_rows: number of rows.
        tip_force: (n_rows, 3) in N, global axes.
        tip_moment: (n_rows, 3) in N mm, global axes.
        distributed_force: (n_rows, 3) in N/mm of reference length, global axes.
        tensions: (n_rows, n_tendons) in N, at the base.
        slides: (n_rows, n_tendons) from -1 to 1, as in `Loads`.
        pressures: (n_rows, n_chambers) in MPa above ambient.

    Raises:
        ConfigError: a value that is not finite, a tendon that pushes, or a shape that does not fit the rod.
    """
    values = {
        "tip_force": (tip_force, 3),
        "tip_moment": (tip_moment, 3),
        "distributed_force": (distributed_force, 3),
        "tensions": (tensions, len(rod.tendons)),
        "slides": (slides, len(rod.tendons)),
        "pressures": (pressures, len(rod.chambers)),
    }
    arrays = {}
    for name, (value, width) in values.items():
        try:
            arrays[name] = np.broadcast_to(np.asarray(value, dtype=np.float64), (n_rows, width))
        except ValueError as error:
            raise ConfigError(
                f"shape {np.shape(value)} does not fit ({n_rows}, {width})",
                where=f"rod loads, field '{name}'",
                fix="give one row per rod, and one column per axis, tendon or chamber of the rod",
            ) from error
        bad = ~np.isfinite(arrays[name]).all(axis=1)
        if bad.any():
            raise ConfigError(
                "not finite", where=f"rod loads, field '{name}', row {np.argmax(bad)}", fix="correct the row"
            )
    slack = (arrays["tensions"] < 0).any(axis=1)
    if slack.any():
        raise ConfigError(
            "a tendon cannot push",
            where=f"rod loads, field 'tensions', row {np.argmax(slack)}",
            fix="give the tension to the tendon on the other side",
        )
    return Loads(**arrays)


@dataclass(frozen=True, slots=True)
class Shape:
    """Equilibrium of `n_rows` rods at `n_elements + 1` equally spaced stations, base first.

    `positions` (n_rows, n_stations, 3) in mm; `quaternions` (n_rows, n_stations, 4), unit, scalar first, rotating the
    rod's axes into global ones; `forces` and `moments` (n_rows, n_stations, 3), in N and N mm, global, are what the
    whole section carries: elastic material, tendons and pressed fluid together.
    """

    positions: Array
    quaternions: Array
    forces: Array
    moments: Array

    def points(self, stations: Rows | Sequence[int], offset: Sequence[float] = (0.0, 0.0)) -> Array:
        """Material points (n_rows, n_points, 3) in mm at `stations`, beside the centreline by `offset` (x, y) mm."""
        index = np.asarray(stations, dtype=int)
        w, x, y, z = np.moveaxis(self.quaternions[:, index], -1, 0)
        across_x = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=-1)
        across_y = np.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], axis=-1)
        return np.asarray(self.positions[:, index] + offset[0] * across_x + offset[1] * across_y)
