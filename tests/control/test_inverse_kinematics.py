"""Inverse kinematics of a leg: poses of forward kinematics are recovered; poses out of reach give the nearest one."""

import dataclasses
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

from humanwalk.body.skeleton import Skeleton
from humanwalk.control.inverse_kinematics import (
    ROW_WEIGHTS,
    SINGULAR_VALUE_FLOOR,
    InverseKinematicsParameters,
    InverseKinematicsSolution,
    LegKinematics,
    joint_velocity,
    pose_error,
    solve_inverse_kinematics,
)
from humanwalk.numerics import Array
from humanwalk.sides import Side

SIDES = ("Right", "Left")
DEFAULT = InverseKinematicsParameters()
STRAIGHT = np.zeros(7)
# Order of a chain: hip flexion, abduction, rotation; knee; ankle dorsiflexion, inversion, toe-in.
BENT = np.array([0.4, 0.05, 0.1, 0.8, 0.2, 0.05, -0.05])
KNEE, ANKLE = 3, 4

INSET = 0.05
"""Fraction of each joint's range at either end that reachable poses avoid."""

sides = st.sampled_from(SIDES)
fractions = st.tuples(*[st.floats(INSET, 1 - INSET)] * 7).map(np.array)
signs = st.tuples(*[st.floats(-0.2, 0.2)] * 7).map(np.array)


def within_range(leg: LegKinematics, fractions: Array) -> Array:
    return leg.lower + fractions * (leg.upper - leg.lower)


def distances(leg: LegKinematics, theta: Array, X_PS: RigidTransform) -> tuple[float, float]:
    """Rotation [rad] and distance [m] between the sole and a pose."""
    error = pose_error(leg.X_PS(theta), X_PS)
    return np.linalg.norm(error[:3]), np.linalg.norm(error[3:])


def assert_consistent(
    leg: LegKinematics,
    solution: InverseKinematicsSolution,
    X_PS: RigidTransform,
    parameters: InverseKinematicsParameters = DEFAULT,
) -> None:
    """For any target the angles are in range, and residual and convergence are reported correctly."""
    assert np.all((leg.lower <= solution.theta) & (solution.theta <= leg.upper))
    assert solution.residual == pytest.approx(np.linalg.norm(pose_error(leg.X_PS(solution.theta), X_PS)), abs=1e-12)
    assert solution.converged == (solution.residual <= parameters.tolerance)


def mirrored(X: RigidTransform) -> RigidTransform:
    """The same pose in a mirror across the sagittal plane."""
    M = np.diag([1.0, -1.0, 1.0])
    return RigidTransform(RotationMatrix(M @ X.rotation().matrix() @ M), M @ X.translation())


# ---- poses within reach


@pytest.mark.parametrize("side", SIDES)
@settings(max_examples=100)
@given(fractions=fractions)
def test_any_reachable_pose_is_found_from_standing(
    legs: dict[Side, LegKinematics], side: Side, fractions: Array
) -> None:
    leg = legs[side]
    X_PS = leg.X_PS(within_range(leg, fractions))
    solution = solve_inverse_kinematics(leg, X_PS, STRAIGHT)
    assert solution.converged
    assert_consistent(leg, solution, X_PS)
    turned, moved = distances(leg, solution.theta, X_PS)
    assert max(turned, moved) <= DEFAULT.tolerance


@pytest.mark.parametrize("side", SIDES)
@settings(max_examples=100)
@given(fractions=fractions, away=signs)
def test_any_reachable_pose_is_found_from_nearby(
    legs: dict[Side, LegKinematics], side: Side, fractions: Array, away: Array
) -> None:
    leg = legs[side]
    theta = within_range(leg, fractions)
    solution = solve_inverse_kinematics(leg, leg.X_PS(theta), theta + away)
    assert solution.converged
    assert_consistent(leg, solution, leg.X_PS(theta))


@settings(max_examples=25)
@given(side=sides, fractions=fractions, away=signs)
def test_numeric_jacobian_leads_to_the_analytic_solution(
    legs: dict[Side, LegKinematics], side: Side, fractions: Array, away: Array
) -> None:
    leg = legs[side]
    theta = within_range(leg, fractions)
    analytic, numeric = (
        solve_inverse_kinematics(leg, leg.X_PS(theta), theta + away, InverseKinematicsParameters(jacobian=kind))
        for kind in ("analytic", "numeric")
    )
    assert analytic.converged
    assert numeric.converged
    np.testing.assert_allclose(numeric.theta, analytic.theta, atol=1e-4)


@settings(max_examples=50)
@given(side=sides, fractions=fractions)
def test_numeric_jacobian_equals_the_analytic(legs: dict[Side, LegKinematics], side: Side, fractions: Array) -> None:
    leg = legs[side]
    theta = within_range(leg, fractions)
    np.testing.assert_allclose(leg.jacobian(theta, "numeric"), leg.jacobian(theta, "analytic"), atol=1e-6)


@settings(max_examples=25)
@given(fractions=fractions, away=signs)
def test_mirrored_legs_have_mirrored_solutions(legs: dict[Side, LegKinematics], fractions: Array, away: Array) -> None:
    """Joint axes are mirrored in the model, so equal angles are mirrored postures."""
    right, left = legs["Right"], legs["Left"]
    theta = within_range(right, fractions)
    X_PS = right.X_PS(theta)
    error = pose_error(left.X_PS(theta), mirrored(X_PS))
    np.testing.assert_allclose(error, 0.0, atol=1e-7)
    solutions = [solve_inverse_kinematics(leg, X, theta + away) for leg, X in ((right, X_PS), (left, mirrored(X_PS)))]
    np.testing.assert_allclose(solutions[0].theta, solutions[1].theta, atol=1e-5)


def test_near_the_target_a_step_squares_the_residual(legs: dict[Side, LegKinematics]) -> None:
    """Newton's method: two steps from 0.02 rad away."""
    leg = legs["Right"]
    solution = solve_inverse_kinematics(leg, leg.X_PS(BENT), BENT + 0.02)
    assert solution.converged
    assert solution.iterations <= 4


def test_a_pose_that_is_already_reached_takes_no_step(legs: dict[Side, LegKinematics]) -> None:
    leg = legs["Left"]
    solution = solve_inverse_kinematics(leg, leg.X_PS(BENT), BENT)
    np.testing.assert_allclose(solution.theta, BENT, rtol=0, atol=1e-15)
    assert (solution.iterations, solution.converged) == (0, True)


# ---- full stretch: a straight knee has rank five (erratum E13)


@pytest.mark.parametrize("side", SIDES)
def test_a_straight_leg_is_singular(legs: dict[Side, LegKinematics], side: Side) -> None:
    assert np.linalg.matrix_rank(legs[side].jacobian(STRAIGHT), tol=1e-9) == 5


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("knee", [0.02, 0.1, 0.5, 1.0, 2.0])
def test_a_straight_knee_bends_toward_a_nearer_target(legs: dict[Side, LegKinematics], side: Side, knee: float) -> None:
    leg = legs[side]
    theta = STRAIGHT + np.array([0.5 * knee, 0, 0, knee, 0.1, 0, 0])
    solution = solve_inverse_kinematics(leg, leg.X_PS(theta), STRAIGHT)
    assert solution.converged
    np.testing.assert_allclose(solution.theta[KNEE], knee, atol=1e-3)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("knee", [0.0, 0.02, 0.5, 1.5])
def test_a_fully_stretched_target_is_reached(legs: dict[Side, LegKinematics], side: Side, knee: float) -> None:
    leg = legs[side]
    solution = solve_inverse_kinematics(leg, leg.X_PS(STRAIGHT), STRAIGHT + np.array([0.5 * knee, 0, 0, knee, 0, 0, 0]))
    assert solution.residual < 1e-5
    # The reach falls short by the square of the knee's angle, so the angle is the root of a tiny residual.
    assert solution.theta[KNEE] < 0.02


# ---- out of reach


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("guess", [STRAIGHT, BENT], ids=["straight", "bent"])
@pytest.mark.parametrize("swing", [0.0, 0.3, -0.3])
def test_a_target_ten_centimeters_out_of_reach_gives_the_nearest_pose(
    legs: dict[Side, LegKinematics], skeleton: Skeleton, side: Side, guess: Array, swing: float
) -> None:
    leg = legs[side]
    beyond = 0.1
    straight = leg.X_PS(np.array([swing, 0, 0, 0, -swing, 0, 0]))
    outward = np.array([np.sin(swing), 0.0, -np.cos(swing)])
    target = RigidTransform(straight.rotation(), straight.translation() + beyond * outward)
    solution = solve_inverse_kinematics(leg, target, guess)
    assert not solution.converged
    assert_consistent(leg, solution, target)

    # No posture brings the sole further from the hip than leg and foot in one line.
    p_PHip = np.array([0.0, -skeleton.hip_half_width if side == "Right" else skeleton.hip_half_width, 0.0])
    reach = skeleton.leg_length + skeleton.ankle_height("Right")
    nearest = np.linalg.norm(target.translation() - p_PHip) - reach
    # And the straight leg with a level sole is 10 cm off: the nearest pose in weighted terms is no worse.
    turned, moved = distances(leg, solution.theta, target)
    assert nearest - 1e-9 <= moved <= beyond + 1e-3
    assert np.hypot(moved, ROW_WEIGHTS[0] * turned) <= beyond + 1e-3
    if swing == 0.0:
        assert nearest == pytest.approx(beyond)
        assert moved == pytest.approx(nearest, abs=1e-3)
        assert turned < 0.02


@settings(max_examples=30)
@given(
    side=sides,
    fractions=fractions,
    p=st.tuples(*[st.floats(-1.5, 1.5)] * 3),
    rpy=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
)
@example(side="Right", fractions=np.full(7, 0.5), p=(0.0, 0.0, 0.0), rpy=(0.0, 3.0, 0.0))
def test_no_target_leads_out_of_the_joint_ranges(
    legs: dict[Side, LegKinematics],
    side: Side,
    fractions: Array,
    p: tuple[float, float, float],
    rpy: tuple[float, float, float],
) -> None:
    leg = legs[side]
    target = RigidTransform(RollPitchYaw(rpy), np.array(p))
    guess = within_range(leg, fractions)
    solution = solve_inverse_kinematics(leg, target, guess)
    assert_consistent(leg, solution, target)

    def cost(theta: Array) -> float:
        return np.linalg.norm(ROW_WEIGHTS * pose_error(leg.X_PS(theta), target))

    assert cost(solution.theta) <= cost(guess) + 1e-12


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("end", [-1, 1])
def test_an_ankle_beyond_its_range_is_not_reached(legs: dict[Side, LegKinematics], side: Side, end: int) -> None:
    """With a straight knee no other joint can replace the ankle's pitch."""
    leg = legs[side]
    theta = STRAIGHT.copy()
    theta[ANKLE] = leg.upper[ANKLE] + 0.3 if end > 0 else leg.lower[ANKLE] - 0.3
    solution = solve_inverse_kinematics(leg, leg.X_PS(theta), STRAIGHT)
    assert not solution.converged
    assert solution.residual > 0.01
    assert_consistent(leg, solution, leg.X_PS(theta))
    assert solution.theta[ANKLE] == pytest.approx((leg.lower if end < 0 else leg.upper)[ANKLE], abs=1e-6)


def test_a_guess_beyond_the_ranges_is_clipped(legs: dict[Side, LegKinematics]) -> None:
    leg = legs["Right"]
    solution = solve_inverse_kinematics(leg, leg.X_PS(BENT), np.full(7, 10.0))
    assert_consistent(leg, solution, leg.X_PS(BENT))


# ---- the seventh joint


def closed_path(leg: LegKinematics, samples: int = 50) -> Iterator[RigidTransform]:
    """A closed path of the sole that is not in a sagittal plane."""
    for turn in 2 * np.pi * np.arange(1, samples + 1) / samples:
        wobble = np.array([0.3, 0.1, 0.2, 0.3, 0.1, 0.08, 0.1]) * np.sin(turn + np.arange(7.0))
        yield leg.X_PS(BENT + wobble)


def angles_after_cycles(leg: LegKinematics, cycles: int, parameters: InverseKinematicsParameters) -> Array:
    theta, ends = BENT, []
    for _ in range(cycles):
        for X_PS in closed_path(leg):
            theta = solve_inverse_kinematics(leg, X_PS, theta, parameters).theta
        ends.append(theta)
    return np.array(ends)


@pytest.mark.parametrize("side", SIDES)
def test_closed_paths_close_in_the_joints_too(legs: dict[Side, LegKinematics], side: Side) -> None:
    """Seven joints for six rows: without the neutral pull the redundant motion drifts from cycle to cycle."""
    ends = angles_after_cycles(legs[side], 10, DEFAULT)
    np.testing.assert_allclose(ends[1:], np.broadcast_to(ends[1], (9, 7)), atol=1e-3)


def test_without_the_neutral_pull_they_do_not_close(legs: dict[Side, LegKinematics]) -> None:
    ends = angles_after_cycles(legs["Right"], 3, dataclasses.replace(DEFAULT, neutral_pull=0.0))
    assert np.abs(ends[2] - ends[1]).max() > 1e-3


# ---- velocities


@settings(max_examples=30)
@given(
    side=sides,
    fractions=st.tuples(*[st.floats(0.2, 0.8)] * 7).map(np.array),
    V=st.tuples(*[st.floats(-1.0, 1.0)] * 6).map(np.array),
)
def test_joint_velocity_is_the_time_derivative_of_the_solutions_along_a_path(
    legs: dict[Side, LegKinematics], side: Side, fractions: Array, V: Array
) -> None:
    leg, h = legs[side], 1e-4
    exact = InverseKinematicsParameters(tolerance=1e-10, neutral_pull=0.0)
    theta = within_range(leg, fractions)
    X_PS = leg.X_PS(theta)

    def angles_at(t: float) -> Array:
        turn = RotationMatrix(RollPitchYaw(t * V[:3]))
        X = RigidTransform(turn @ X_PS.rotation(), X_PS.translation() + t * V[3:])
        solution = solve_inverse_kinematics(leg, X, theta, exact)
        assert solution.converged
        return solution.theta

    quotient = (angles_at(h) - angles_at(-h)) / (2 * h)
    velocity = joint_velocity(leg, theta, V, exact)
    np.testing.assert_allclose(leg.jacobian(theta) @ velocity, V, atol=1e-9)
    np.testing.assert_allclose(quotient, velocity, atol=1e-3 * (1 + np.abs(velocity).max()))


def test_joint_velocity_stays_finite_at_full_stretch(legs: dict[Side, LegKinematics]) -> None:
    """No joint velocity shortens a straight leg."""
    for kind in ("analytic", "numeric"):
        velocity = joint_velocity(
            legs["Right"], STRAIGHT, np.array([0, 0, 0, 0, 0, 1.0]), InverseKinematicsParameters(jacobian=kind)
        )
        assert np.abs(velocity).max() < 1.0 / SINGULAR_VALUE_FLOOR


@pytest.mark.parametrize("V", [np.eye(6)[i] * s for i in range(6) for s in (-1, 1)])
def test_joints_at_the_end_of_their_range_do_not_move_outward(legs: dict[Side, LegKinematics], V: Array) -> None:
    leg = legs["Right"]
    assert np.all(joint_velocity(leg, leg.upper, V) <= 0)
    assert np.all(joint_velocity(leg, leg.lower, V) >= 0)


# ---- residual


@given(angle=st.floats(0.001, 3.1), p=st.tuples(*[st.floats(-1, 1)] * 3))
def test_pose_error_is_rotation_vector_and_translation(angle: float, p: tuple[float, float, float]) -> None:
    X_desired = RigidTransform(RollPitchYaw(0.3, -0.2, 0.1), [1.0, 0.0, 0.0])
    X = RigidTransform(
        RotationMatrix.MakeYRotation(angle) @ X_desired.rotation(), X_desired.translation() + np.array(p)
    )
    np.testing.assert_allclose(pose_error(X, X_desired), [0, angle, 0, *p], atol=1e-7)


def test_pose_error_does_not_jump_where_euler_angles_do() -> None:
    """Thesis Eq 4-3 subtracts Euler angles, which differ by 2 pi here (erratum E13)."""
    before, after = (RigidTransform(RotationMatrix.MakeZRotation(np.pi + e)) for e in (-0.01, 0.01))
    np.testing.assert_allclose(pose_error(after, before), [0, 0, 0.02, 0, 0, 0], atol=1e-9)
