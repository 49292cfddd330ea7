"""A simulated soft finger with two antagonistic pairs of tendons and a marker at its tip: ideal, and as on a bench.

Their size, command ranges and units are those of ELASTICA and FINGER. Both tendons of a pair are under tension at rest;
a command shifts tension from one to the other, so that none goes slack. The ideal finger takes that difference in N:
positive bends it towards +x (first command) or +y (second). The finger on the bench takes motor counts, turned like
FINGER's axes: its first command bends it towards +y, its second towards -x. There tendons rub in their channels, the
drives have backlash, and a motion capture system measures the tip.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from softkin.core.samples import Array
from softkin.data.standins.cosserat_rod import solve
from softkin.data.standins.robot import StandIn, in_box, in_disc
from softkin.data.standins.rod import Rod, Shape, disc, loads, section

RADIUS, TENDON_OFFSET = 10.0, 8.0
#: Pulled by a positive first and second command, then by a negative one.
TENDONS = ((TENDON_OFFSET, 0.0), (0.0, TENDON_OFFSET), (-TENDON_OFFSET, 0.0), (0.0, -TENDON_OFFSET))
YOUNG_MODULUS = 7.0  # MPa: a firm casting urethane
DENSITY = 1.1e-3  # g/mm3
SPINE = 20.0  # a fabric spine on the centreline: it bends freely, and stretches so much less than the urethane
N_ELEMENTS = 24
LARGEST_TENSION = 40.0  # N

LARGEST_COUNT = 2000.0
TENSION_PER_COUNT = 0.033  # N
#: Half the play of a drive, in counts; reversing it, a tendon stops, then slides the other way.
BACKLASH = 30.0
FRICTION = 0.12
NOISE_MM = 0.15  # standard deviation per coordinate: a motion capture system at close range


def _rod() -> Rod:
    area, second_moment = disc(RADIUS)
    (shear, _, stretch), bend = section(YOUNG_MODULUS, area, second_moment)
    return Rod(120.0, (shear, shear, SPINE * stretch), bend, mass_per_length=DENSITY * area, tendons=TENDONS)


ROD = _rod()
BENCH_ROD = replace(ROD, length=127.0, tendons=tuple((-y, x) for x, y in TENDONS), friction=FRICTION)


def _shapes(rod: Rod, pulls: Array, largest: float, slides: Array | float, label: str) -> Shape:
    """Shapes under differences of tension `pulls` (n_rows, 2) in N, at most `largest`; standing up."""
    tensions = (largest + np.hstack([pulls, -pulls])) / 2
    weight = (0.0, 0.0, -rod.weight_per_length)
    loaded = loads(rod, len(pulls), distributed_force=weight, tensions=tensions, slides=slides)
    return solve(rod, loaded, n_elements=N_ELEMENTS, label=label)


def _draw(n_rows: int, rng: np.random.Generator) -> Array:
    return in_box(n_rows, (-LARGEST_TENSION,) * 2, (LARGEST_TENSION,) * 2, rng)


def _poses(commands: Array, _: np.random.Generator) -> Array:
    return _shapes(ROD, commands, LARGEST_TENSION, 0.0, SPEC.name).positions[:, -1]


def play(commands: Array, half_width: float) -> tuple[Array, Array]:
    """Backlash: the play operator along a sequence of commands (n_rows, n_commands), from rest at zero.

    Returns the output of the drive, within `half_width` of the command, and where in its play the drive stands, from
    -1 to 1 (the stop operator); both (n_rows, n_commands). Source: Krasnosel'skii and Pokrovskii (1989),
    Systems with Hysteresis.
    """
    within, last = np.zeros(commands.shape[1]), np.zeros(commands.shape[1])
    stops = np.empty_like(commands)
    for row, command in enumerate(commands):
        within = np.clip(within + (command - last) / half_width, -1.0, 1.0)
        stops[row], last = within, command
    return commands - half_width * stops, stops


def bench_shapes(commands: Array) -> Shape:
    """Shapes of the finger on the bench, before measurement; commands in counts, in their order."""
    counts, stops = play(commands, BACKLASH)
    pulls, largest = TENSION_PER_COUNT * counts, TENSION_PER_COUNT * LARGEST_COUNT
    return _shapes(BENCH_ROD, pulls, largest, np.hstack([stops, -stops]), FRICTIONAL.name)


def bench_tips(commands: Array) -> Array:
    """The tips (n_rows, 3) of these shapes in mm."""
    return bench_shapes(commands).positions[:, -1]


def _bench_poses(commands: Array, rng: np.random.Generator) -> Array:
    return bench_tips(commands) + NOISE_MM * rng.standard_normal((len(commands), 3))


def _bench_draw(n_rows: int, rng: np.random.Generator) -> Array:
    return in_disc(n_rows, LARGEST_COUNT, rng)


SPEC = StandIn("tendon_finger", "simulated tendon finger", 2, 1, _draw, _poses)
FRICTIONAL = StandIn(
    "tendon_finger_frictional",
    "simulated tendon finger with friction, backlash and measurement noise",
    2,
    1,
    _bench_draw,
    _bench_poses,
)
#: Shares of the rows of each session, and how far its zero may be off: about those of FINGER.
RECORDED = replace(
    FRICTIONAL,
    name="tendon_finger_recorded",
    title="simulated tendon finger with friction and backlash, recorded in three sessions",
    sessions=(0.46, 0.21, 0.33),
    zero_mm=(1.5, 1.5, 0.2),
)
