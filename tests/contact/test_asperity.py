"""The asperity law: it only pushes, friction stays in its cone, the spring holds up to its breaking factor."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.contact.asperity import (
    AsperityParameters,
    Knot,
    friction_bound,
    friction_force,
    normal_force,
    point_damping,
    point_stiffness,
)
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY, ParameterError, check

LAW = AsperityParameters()
AREA = np.array([1e-3])
DEPTHS = st.floats(-0.01, 0.01)
RATES = st.floats(-3.0, 3.0)
FORCES = st.floats(0.0, 1e4)
PLANAR = st.tuples(RATES, RATES).map(np.array)
MU = 0.7


def normal(law: AsperityParameters, depth: float, rate: float) -> float:
    height, rising = np.array([-depth]), np.array([-rate])
    linear = -point_stiffness(law, AREA)[:, 2] * height - point_damping(law, AREA, rate < 0.0)[:, 2] * rising
    return float(normal_force(law, law.normal_pressure * AREA + linear, height)[0])


def friction(law: AsperityParameters, stretch: Array, velocity: Array, bound: float) -> tuple[Array, Array]:
    spring = point_stiffness(law, AREA)[:, :2] * stretch
    force, kept = friction_force(law, spring, -spring - point_damping(law, AREA)[:, :2] * velocity, np.array([bound]))
    return force[0], kept[0] * np.asarray(stretch)


def test_the_thesis_numbers_are_the_defaults() -> None:
    assert (LAW.spring_stiffness, LAW.velocity_stiffness) == (5e7, 1e6)
    assert (LAW.breaking_factor, LAW.averaging, LAW.separation_damping) == (0.975, 0.75, 1.0)
    assert (LAW.normal_pressure, LAW.stiction) == (0.0, 0.0)
    check(LAW)


@given(depth=DEPTHS, rate=RATES)
def test_the_ground_only_pushes_and_only_what_is_below_it(depth: float, rate: float) -> None:
    force = normal(LAW, depth, rate)
    assert force >= 0.0
    if depth <= 0.0:
        assert force == 0.0


@given(depth=st.floats(1e-6, 0.01), rate=st.floats(0.0, 3.0))
def test_normal_force_is_area_times_stiffness_depth_and_damping_rate(depth: float, rate: float) -> None:
    expected = 1e-3 * (5e7 * depth + 4e5 * rate)
    assert normal(LAW, depth, rate) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("factor", [0.0, 0.5, 1.0])
def test_damping_counts_by_its_separation_factor_while_the_surfaces_part(factor: float) -> None:
    law = dataclasses.replace(LAW, separation_damping=factor)
    assert normal(law, 1e-3, -0.05) == pytest.approx(1e-3 * (5e4 - factor * 4e5 * 0.05))


def test_stiction_limits_the_pull_on_a_point() -> None:
    sticky = dataclasses.replace(LAW, stiction=3.0)
    assert normal(sticky, 1e-5, -1.0) == -3.0
    assert normal(sticky, -1e-5, -1.0) == 0.0


def test_pressure_is_added_where_there_is_contact() -> None:
    law = dataclasses.replace(LAW, normal_pressure=1e4)
    assert normal(law, 1e-3, 0.0) == pytest.approx(60.0)
    assert normal(law, -1e-3, 0.0) == 0.0


@given(stretch=PLANAR, velocity=PLANAR, bound=FORCES)
def test_friction_stays_within_its_bound(stretch: Array, velocity: Array, bound: float) -> None:
    force, held = friction(LAW, stretch, velocity, bound)
    assert np.hypot(*force) <= bound * (1 + 1e-12) + 1e-300
    assert LAW.spring_stiffness * AREA[0] * np.hypot(*held) <= 0.975 * bound * (1 + 1e-12) + 1e-300


@given(velocity=PLANAR, bound=FORCES)
def test_friction_without_a_stretched_spring_opposes_the_velocity(velocity: Array, bound: float) -> None:
    force, _ = friction(LAW, np.zeros(2), velocity, bound)
    assert force @ velocity <= 0.0
    assert abs(force[0] * velocity[1] - force[1] * velocity[0]) <= 1e-9 * bound


@given(share=st.floats(0.01, 0.97), angle=st.floats(0.0, 6.28))
def test_a_resting_point_is_held_by_its_spring_up_to_the_breaking_factor(share: float, angle: float) -> None:
    stretch = share * 100.0 / (5e7 * 1e-3) * np.array((np.cos(angle), np.sin(angle)))
    force, held = friction(LAW, stretch, np.zeros(2), 100.0)
    np.testing.assert_allclose(held, stretch)
    np.testing.assert_allclose(force, -5e4 * stretch)


@pytest.mark.parametrize("factor", [0.5, 0.975])
def test_beyond_the_breaking_factor_the_anchor_is_dragged(factor: float) -> None:
    law = dataclasses.replace(LAW, breaking_factor=factor)
    force, held = friction(law, np.array((1.0, 0.0)), np.zeros(2), 100.0)
    np.testing.assert_allclose(force, (-factor * 100.0, 0.0))
    np.testing.assert_allclose(held, (factor * 100.0 / 5e4, 0.0))


def test_the_velocity_law_has_two_segments() -> None:
    """E8's check: 0.7 m g on both soles, 0.0456 m2, is reached at 10.5 mm/s of slip."""
    area, bound = np.full(4, 0.0456), np.full(4, 0.7 * 70.0 * GRAVITY)
    speeds = np.array([1e-3, 5e-3, 10.5e-3, 50e-3])
    velocities = np.column_stack((speeds, np.zeros(4)))
    forces, _ = friction_force(LAW, np.zeros((4, 2)), -point_damping(LAW, area)[:, :2] * velocities, bound)
    forces = np.hypot(*forces.T)
    np.testing.assert_allclose(forces[:2], 1e6 * 0.0456 * speeds[:2])
    assert forces[2] == pytest.approx(bound[0], rel=0.005)
    assert forces[3] == pytest.approx(bound[0], rel=1e-12)


def test_multipliers_change_the_coefficient_over_time_and_pressure() -> None:
    law = AsperityParameters(
        time_multiplier=(Knot(at=1.0, factor=1.0), Knot(at=2.0, factor=0.0)),
        pressure_multiplier=(Knot(at=0.0, factor=1.0), Knot(at=1e5, factor=0.5)),
    )
    normal = AREA * np.array([0.0, 5e4, 2e5])

    def bound(time: float, law: AsperityParameters = law) -> Array:
        return friction_bound(law, MU, normal, normal, AREA, time)

    np.testing.assert_allclose(bound(0.0), 0.7 * normal * [1.0, 0.75, 0.5])
    np.testing.assert_allclose(bound(1.5), 0.35 * normal * [1.0, 0.75, 0.5])
    np.testing.assert_allclose(bound(3.0), 0.0, atol=1e-12)
    np.testing.assert_allclose(bound(3.0, LAW), 0.7 * normal)


@given(normal=st.floats(-3.0, 100.0), load=st.floats(0.0, 100.0))
def test_friction_is_limited_by_the_smaller_of_normal_force_and_its_mean(normal: float, load: float) -> None:
    law = dataclasses.replace(LAW, stiction=3.0)
    bound = friction_bound(law, MU, np.array([normal]), np.array([load]), AREA, 0.0)
    assert bound[0] == pytest.approx(0.7 * max(0.0, min(normal, load)))


def test_knots_out_of_order_are_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"contact.asperity.time_multiplier.1.at: 1 comes after 2; .* sort the knots"
    ):
        AsperityParameters(time_multiplier=(Knot(at=2.0), Knot(at=1.0)))
