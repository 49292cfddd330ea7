"""A simulated soft arm with three pressure chambers and seven markers, the stand-in for ABAQUS.

It has the size, command ranges and units of the published arm: 1.8 m, standing on its base, seven markers 0.3 m apart
along one side, the first on the clamped base. A command is the pressure load of a chamber as in the published files, in
MPa and negative where the chamber is inflated: one chamber does most of the work, the other two trim. The arm is
moulded with a slight bow, and leans at rest as the published one does.
"""

from __future__ import annotations

import math

import numpy as np

from softkin.core.samples import Array
from softkin.data.standins.cosserat_rod import solve
from softkin.data.standins.robot import StandIn, in_box
from softkin.data.standins.rod import Rod, disc, loads, section

LENGTH, RADIUS = 1800.0, 58.0
CHAMBER_RADIUS, CHAMBER_OFFSET = 20.0, 36.0
YOUNG_MODULUS = 27.0  # MPa: a soft thermoplastic polyurethane
DENSITY = 1.15e-3  # g/mm3
#: The first chamber faces +x +y: inflated, it bends the arm towards -x -y, where the markers are.
DIRECTIONS = tuple(math.radians(angle) for angle in (45.0, 165.0, 285.0))
CHAMBERS = tuple((CHAMBER_OFFSET * math.cos(angle), CHAMBER_OFFSET * math.sin(angle)) for angle in DIRECTIONS)
BOW = 0.22  # rad over the length, in the same plane
MARKER_OFFSET = (-41.0, -41.0)
LOWER, UPPER = (-1.0, -0.1, -0.1), (0.1, 0.1, -0.08)
N_MARKERS, N_ELEMENTS = 7, 24


def _rod() -> Rod:
    area, second_moment = disc(RADIUS)
    hole, own_moment = disc(CHAMBER_RADIUS)
    # Three equal holes at 120 degrees take the same from the second moment about every diameter.
    material = area - 3 * hole
    stiff = section(YOUNG_MODULUS, material, second_moment - 3 * (own_moment + hole * CHAMBER_OFFSET**2 / 2))
    bow = BOW / LENGTH / math.sqrt(2)
    return Rod(
        LENGTH,
        *stiff,
        natural_curvature=(bow, -bow, 0.0),
        mass_per_length=DENSITY * material,
        chambers=CHAMBERS,
        chamber_area=hole,
    )


ROD = _rod()


def _draw(n_rows: int, rng: np.random.Generator) -> Array:
    return in_box(n_rows, LOWER, UPPER, rng)


def _poses(commands: Array, _: np.random.Generator) -> Array:
    weight = (0.0, 0.0, -ROD.weight_per_length)
    loaded = loads(ROD, len(commands), distributed_force=weight, pressures=-commands)
    shape = solve(ROD, loaded, n_elements=N_ELEMENTS, label=SPEC.name)
    stations = np.arange(N_MARKERS) * (N_ELEMENTS // (N_MARKERS - 1))
    return shape.points(stations, MARKER_OFFSET).reshape(len(commands), -1)


SPEC = StandIn("pneumatic_arm", "simulated pneumatic arm", 3, N_MARKERS, _draw, _poses)
