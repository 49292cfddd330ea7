"""The rod against another program that knows rods."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.data.standins.cosserat_rod import solve
from softkin.data.standins.rod import STANDARD_GRAVITY, Rod, disc, loads, section


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")  # those of PyElastica and numba
def test_pyelastica_comes_to_rest_in_the_same_shape() -> None:
    """PyElastica moves the rod in time, strongly damped, in SI units; its shear stiffness carries a factor 27/28.

    Its first element is clamped and does not bend, an error of first order in the element's length: it is extrapolated
    to none, as is that of second order.
    """
    elastica = pytest.importorskip(
        "elastica", reason="PyElastica is not installed: pip install pyelastica, to compare the rod with it"
    )
    young, radius, length, density = 7.0, 10.0, 120.0, 1.1e-3  # MPa, mm, mm, g/mm3
    force, time_step, seconds = np.array([2.5, 1.5, -0.5]), 1e-5, 0.4
    area, second_moment = disc(radius)
    (shear, _, stretch), bend = section(young, area, second_moment)
    rod = Rod(length, (shear * 27 / 28, shear * 27 / 28, stretch), bend, mass_per_length=density * area)
    ours = solve(
        rod, loads(rod, 1, tip_force=force, distributed_force=(0, 0, -rod.weight_per_length)), n_elements=48
    ).positions[0, -1]

    class Bench(
        elastica.BaseSystemCollection,  # type: ignore[misc, name-defined]
        elastica.Constraints,  # type: ignore[misc, name-defined]
        elastica.Forcing,  # type: ignore[misc, name-defined]
        elastica.Damping,  # type: ignore[misc, name-defined]
    ):
        pass

    def at_rest(n_elements: int) -> Array:
        moving = elastica.CosseratRod.straight_rod(
            n_elements,
            start=np.zeros(3),
            direction=np.array([0.0, 0.0, 1.0]),
            normal=np.array([1.0, 0.0, 0.0]),
            base_length=length / 1e3,
            base_radius=radius / 1e3,
            density=density * 1e6,
            youngs_modulus=young * 1e6,
            shear_modulus=young * 1e6 / 3,
        )
        bench = Bench()
        bench.append(moving)
        bench.constrain(moving).using(
            elastica.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
        )
        bench.add_forcing_to(moving).using(elastica.EndpointForces, np.zeros(3), force, ramp_up_time=0.05)
        bench.add_forcing_to(moving).using(
            elastica.GravityForces, acc_gravity=np.array([0.0, 0.0, -STANDARD_GRAVITY * 1e3])
        )
        bench.dampen(moving).using(elastica.AnalyticalLinearDamper, uniform_damping_constant=150.0, time_step=time_step)
        bench.finalize()
        steps = round(seconds / time_step)
        elastica.integrate(elastica.PositionVerlet(), bench, seconds, steps, progress_bar=False)
        assert np.abs(moving.velocity_collection).max() < 1e-6  # m/s
        return np.asarray(moving.position_collection[:, -1] * 1e3)

    coarse, middle, fine = (at_rest(n_elements) for n_elements in (10, 20, 40))
    expected = (4 * (2 * fine - middle) - (2 * middle - coarse)) / 3
    assert np.linalg.norm(expected - [0, 0, length]) > 20  # mm: it does bend
    np.testing.assert_allclose(ours, expected, atol=0.05)
