"""PD law of the joints: its formula, its discretizations, and the step up to which they are stable."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap, base_first_mass_matrix
from humanwalk.control.joint_gains import JointGains, joint_gains
from humanwalk.control.pd_control import PD_LAWS, PdLaw, largest_pd_step, linear_update, pd_torque
from humanwalk.numerics import Array

LAWS = sorted(PD_LAWS)
numbers, gains = st.floats(-10.0, 10.0), st.floats(0.0, 1e4)
stiffness, damping, steps = st.floats(1.0, 1e5), st.floats(0.0, 100.0), st.floats(1e-5, 1e-2)


@pytest.fixture(scope="module")
def mass_matrix(plant: MultibodyPlant) -> Array:
    return base_first_mass_matrix(plant)


def step_of(law: PdLaw, inertia: float, kp: float, kd: float, **more: Any) -> float:
    return largest_pd_step(np.array([[inertia]]), np.array([kp]), np.array([kd]), law, **more)


@given(numbers, numbers, numbers, numbers, gains, gains)
def test_torque_is_stiffness_times_angle_error_plus_damping_times_rate_error(
    q: float, v: float, q_d: float, v_d: float, kp: float, kd: float
) -> None:
    tau = pd_torque(*(np.array([x]) for x in (q, v, q_d, v_d, kp, kd)))
    assert tau[0] == pytest.approx(kp * (q_d - q) + kd * (v_d - v))


def test_the_damping_opposes_the_motion() -> None:
    """Erratum E10: as printed, the damping has the opposite sign."""
    one = np.ones(1)
    assert pd_torque(0 * one, one, 0 * one, 0 * one, 0 * one, one)[0] < 0


@given(st.floats(0.01, 10.0), stiffness, damping, steps, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_one_joint_steps_by_the_formula_of_its_discretization(
    inertia: float, kp: Any, kd: Any, h: Any, q: float, v: float
) -> None:
    """I (v' - v) = -h (kp q + kd v), with v' for v in what is implicit and q + h v' for q with the implicit law."""
    after = {
        "explicit": v - h * (kp * q + kd * v) / inertia,
        "semi_implicit": (inertia * v - h * kp * q) / (inertia + h * kd),
        "implicit": (inertia * v - h * kp * q) / (inertia + h * kd + h**2 * kp),
    }
    for law, expected in after.items():
        D, E = PD_LAWS[law].impedance(h, np.array([kp]), np.array([kd]))  # type: ignore[index]
        q_next, v_next = linear_update(h, np.array([[inertia]]), D, E, np.array([kp])) @ [q, v]
        assert v_next == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert q_next == pytest.approx(q + h * expected, rel=1e-9, abs=1e-9)


@given(stiffness, damping)
def test_the_stable_explicit_step_of_one_joint_is_that_of_the_textbook(kp: float, kd: float) -> None:
    """Semi-implicit Euler of I q'' = -kp q - kd q' is stable while kp h^2 + 2 kd h < 4 I."""
    limit = (-kd + np.sqrt(kd**2 + 4 * 0.01 * kp)) / kp
    assert step_of("explicit", 0.01, kp, kd) == pytest.approx(min(0.1, limit), rel=0.011)


@given(stiffness, damping)
def test_the_stable_semi_implicit_step_of_one_joint_is_that_of_the_textbook(kp: float, kd: float) -> None:
    """(I + h kd) q'' = -kp q is stable while kp h^2 < 4 I + 2 kd h."""
    limit = (kd + np.sqrt(kd**2 + 4 * kp * 0.1)) / kp
    assert step_of("semi_implicit", 0.1, kp, kd) == pytest.approx(min(0.1, limit), rel=0.011)


@given(stiffness, damping)
def test_the_implicit_law_of_one_joint_is_stable_at_any_step(kp: float, kd: float) -> None:
    assert step_of("implicit", 0.01, kp, kd, upper=1.0) == 1.0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("held", [0, 21, 42])
def test_joints_without_gains_are_stable(mass_matrix: Any, law: Any, held: int) -> None:
    """A joint that nothing drives moves freely: a double eigenvalue of 1, which is not a divergence."""
    kp, kd = (gain * (np.arange(42) < held) for gain in (1.0, 0.001))
    assert largest_pd_step(mass_matrix, kp, kd, law, upper=0.001) == 0.001  # type: ignore[arg-type]


@pytest.mark.parametrize("law", ["explicit", "semi_implicit"])
def test_a_lighter_joint_needs_a_shorter_step(law: PdLaw) -> None:
    heavy, light = (step_of(law, inertia, 1e4, 10.0) for inertia in (0.1, 0.001))
    assert light < heavy / 2


def test_a_free_base_makes_joints_lighter_and_the_step_shorter(
    plant: MultibodyPlant, mass_matrix: Array, joints: JointMap
) -> None:
    kp, kd = joint_gains(plant, JointGains())
    floating, held = (largest_pd_step(M, kp, kd, "explicit") for M in (mass_matrix, mass_matrix[6:, 6:]))
    assert floating <= held * 1.01
