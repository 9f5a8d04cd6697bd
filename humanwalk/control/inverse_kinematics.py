"""Inverse kinematics of one leg by Newton's method with least squares (thesis section 4.1).

The thesis solves J^T J dtheta = -J^T G for the residual G between the pose of the sole and its desired pose. As printed
that system is singular: a leg has seven joints for six rows, and rank five with a straight knee (erratum E13). Here the
step is the least-squares one, damped in proportion to the residual, kept inside the joint ranges, and accepted only if
it reduces the residual. A target out of reach gives the nearest pose, marked as not converged.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import FixedOffsetFrame, JacobianWrtVariable, RevoluteJoint

from humanwalk.numerics import Array
from humanwalk.numerics.rotation import rotation_vector
from humanwalk.quantity import quantity

JacobianKind = Literal["analytic", "numeric"]

STEP_FRACTIONS = (1.0, 0.5, 0.25, 0.1, 0.03, 0.003)
"""Fractions of a Newton step, tried in this order until one reduces the residual."""

STATIONARY_GAIN = 1e-6
"""Relative reduction of the residual by a step below which the pose counts as the nearest."""

MIN_DAMPING = 1e-6
"""Least damping of a step [m/rad] (our choice): J J^T of a straight leg has no inverse."""

RESTART_GAIN = 0.5
"""Fraction of the first residual below which the pose of the second start is taken: a smaller improvement does not
justify a jump of the joints."""

ROW_WEIGHTS = np.array((0.03, 0.03, 0.03, 1.0, 1.0, 1.0))
"""Weights of the residual [rotation [m/rad]; position]: length equivalent to one radian of orientation error if a
target is out of reach (our choice). It is less than the height of the ankle, so that the sole keeps its position and
gives way in pitch."""

DAMPING = 0.5
"""Damping of a step per weighted residual [1/rad] (after Sugihara 2011): short steps far from the target and near
singular postures, pure Newton steps near the target."""

SINGULAR_VALUE_FLOOR = 0.01
"""Singular value of the weighted J [m/rad] below which joint velocities do not grow further (our choice)."""

MAX_STEP = 0.5
"""Maximum change of any joint in one step [rad] (our choice); keeps the linearization valid."""

DIFFERENCE_STEP = 1e-6
"""Half width of the central differences of the numeric Jacobian [rad]."""


@dataclass(frozen=True)
class InverseKinematicsParameters:
    """Settings of the Newton iteration."""

    jacobian: JacobianKind = "analytic"
    """Drake's Jacobian, or central differences as in the thesis (section 1.4)."""

    tolerance: float = quantity(1e-5, "m, rad", 1e-10, 1e-2)
    """Norm of the residual at which a pose counts as reached (exactly 0 in the thesis): 10 micrometers are a 500th of
    what the feet deviate by in the walk."""

    max_iterations: int = quantity(50, "", 1, 1000)
    """Maximum number of Newton steps."""

    neutral_pull: float = quantity(0.1, "", 0.0, 1.0)
    """Fraction of each angle that the first step takes back in the null space of J: seven joints for six rows have one
    redundant motion, which would drift from cycle to cycle."""


class InverseKinematicsSolution(NamedTuple):
    """Result of the iteration.

    Attributes:
        theta: joint angles [rad], shape (n,), inside the joint ranges.
        residual: norm of [rotation vector [rad]; position error [m]] at `theta`.
        iterations: number of Newton steps.
        converged: whether `residual` is within the tolerance; if not, `theta` is the nearest pose found.
    """

    theta: Array
    residual: float
    iterations: int
    converged: bool


class LegKinematics:
    """The chain of joints between a base frame P and a tip frame S of a plant, as a plant of its own.

    Attributes:
        joint_names: the n joints of the chain, in the order of theta.
        lower, upper: joint ranges [rad], shape (n,).
    """

    def __init__(self, plant: MultibodyPlant, base_frame: str, tip_frame: str, joint_names: Sequence[str]) -> None:
        """Make the chain.

        Args:
            plant: a finalized plant.
            base_frame: name of the frame P in which poses are measured; the world frame of the chain.
            tip_frame: name of the frame S that is to be placed.
            joint_names: revolute joints between P and S, from P outward; no others lie between them.
        """
        joints = [cast(RevoluteJoint, plant.GetJointByName(name)) for name in joint_names]
        self.joint_names = tuple(joint_names)
        self.lower = np.array([joint.position_lower_limits()[0] for joint in joints])
        self.upper = np.array([joint.position_upper_limits()[0] for joint in joints])
        self._plant = chain = MultibodyPlant(time_step=0.0)
        self._P = end = chain.world_frame()
        context, inner = plant.CreateDefaultContext(), plant.GetFrameByName(base_frame)
        for joint in joints:
            outer = joint.frame_on_parent()
            hinge = chain.AddFrame(FixedOffsetFrame(f"{joint.name()}_hinge", end, outer.CalcPose(context, inner)))
            inner, end = joint.frame_on_child(), chain.AddRigidBody(joint.name()).body_frame()
            chain.AddJoint(RevoluteJoint(joint.name(), hinge, end, joint.revolute_axis()))
        X_tip = plant.GetFrameByName(tip_frame).CalcPose(context, inner)
        self._S = chain.AddFrame(FixedOffsetFrame(tip_frame, end, X_tip))
        chain.Finalize()
        self._context = chain.CreateDefaultContext()

    def X_PS(self, theta: Array) -> RigidTransform:
        """Pose of the tip S in the base P at joint angles theta [rad], shape (n,)."""
        self._plant.SetPositions(self._context, theta)
        return self._S.CalcPoseInWorld(self._context)

    def jacobian(self, theta: Array, kind: JacobianKind = "analytic") -> Array:
        """Jacobian of the spatial velocity [angular; translational] of S in P, expressed in P; shape (6, n)."""
        return self._analytic_jacobian(theta) if kind == "analytic" else self._numeric_jacobian(theta)

    def _analytic_jacobian(self, theta: Array) -> Array:
        self._plant.SetPositions(self._context, theta)
        J: Array = self._plant.CalcJacobianSpatialVelocity(
            self._context, JacobianWrtVariable.kV, self._S, np.zeros(3), self._P, self._P
        )
        return J

    def _numeric_jacobian(self, theta: Array) -> Array:
        """Central differences, as in the thesis (section 1.4)."""
        steps = DIFFERENCE_STEP * np.eye(theta.size)
        differences = [pose_error(self.X_PS(theta + step), self.X_PS(theta - step)) for step in steps]
        return np.column_stack(differences) / (2 * DIFFERENCE_STEP)


def pose_error(X: RigidTransform, X_desired: RigidTransform) -> Array:
    """[rotation vector; translation] from X_desired to X, in their common frame; shape (6,).

    The rotation vector replaces the thesis' difference of Euler angles (Eq 4-3), which jumps at +-pi (E13).
    """
    rotation = rotation_vector(X_desired.rotation().matrix(), X.rotation().matrix())
    return np.concatenate((rotation, X.translation() - X_desired.translation()))


def solve_inverse_kinematics(
    leg: LegKinematics,
    X_PS_desired: RigidTransform,
    theta_guess: Array,
    parameters: InverseKinematicsParameters | None = None,
) -> InverseKinematicsSolution:
    """Joint angles that bring the sole to a desired pose (thesis Eq 4-3 to 4-5).

    Joints at the end of their range and a straight leg can stall the iteration short of a pose within reach.
    An iteration that stalls is therefore repeated with those joints in the middle of their ranges.

    Args:
        leg: the kinematic chain, n joints.
        X_PS_desired: desired pose of the sole S in the pelvis P.
        theta_guess: warm start [rad], shape (n,); clipped to the joint ranges.
        parameters: settings of the iteration.
    """
    parameters = parameters or InverseKinematicsParameters()
    first, first_cost = _iterate(leg, X_PS_desired, theta_guess, parameters)
    if first.converged:
        return first
    at_end = (first.theta <= leg.lower) | (first.theta >= leg.upper)
    restart = np.where(at_end, 0.5 * (leg.lower + leg.upper), first.theta)
    second, second_cost = _iterate(leg, X_PS_desired, restart, parameters)
    is_better = second.converged or second_cost < RESTART_GAIN * first_cost
    return (second if is_better else first)._replace(iterations=first.iterations + second.iterations)


def _iterate(
    leg: LegKinematics, X_PS_desired: RigidTransform, theta_guess: Array, parameters: InverseKinematicsParameters
) -> tuple[InverseKinematicsSolution, float]:
    """Newton steps until none reduces the residual; the solution and the norm of its weighted residual."""

    def residual(theta: Array) -> tuple[Array, float]:
        """The residual G and its weighted norm."""
        G = pose_error(leg.X_PS(theta), X_PS_desired)
        return G, math.hypot(*(ROW_WEIGHTS * G))

    theta = theta_guess.clip(leg.lower, leg.upper)
    G, cost = residual(theta)
    iterations, pull = 0, parameters.neutral_pull
    while math.hypot(*G) > parameters.tolerance and iterations < parameters.max_iterations:
        iterations += 1
        J = ROW_WEIGHTS[:, None] * leg.jacobian(theta, parameters.jacobian)
        step = _newton_step(leg, theta, J, ROW_WEIGHTS * G, DAMPING * cost, pull)
        step *= MAX_STEP / max(np.abs(step).max(), MAX_STEP)
        # Far from the target and at the ends of the joint ranges a full step can increase the residual.
        for fraction in STEP_FRACTIONS:
            trial = (theta + fraction * step).clip(leg.lower, leg.upper)
            trial_G, trial_cost = residual(trial)
            if trial_cost < cost:
                break
        gain = cost - trial_cost
        # A step with the neutral pull does not show what a pure Newton step would gain.
        is_stationary = gain < STATIONARY_GAIN * cost and not pull
        if gain > 0:
            theta, G, cost = trial, trial_G, trial_cost
        if is_stationary:
            break
        pull = 0.0
    norm = math.hypot(*G)
    return InverseKinematicsSolution(theta, norm, iterations, norm <= parameters.tolerance), cost


def _newton_step(leg: LegKinematics, theta: Array, J: Array, G: Array, damping: float, pull: float) -> Array:
    """Step -J+ G - (1 - J+ J) pull theta with the damped inverse J+ = J^T (J J^T + damping^2)^-1; shape (n,)."""
    back = -pull * theta
    added = (damping**2 + MIN_DAMPING**2) * np.eye(len(G))

    def step_of(J: Array) -> Array:
        step: Array = back - J.T @ np.linalg.solve(J @ J.T + added, G + J @ back)
        return step

    return _within_ranges(leg, theta, J, step_of)


def joint_velocity(
    leg: LegKinematics,
    theta: Array,
    V_PS_desired: Array,
    parameters: InverseKinematicsParameters | None = None,
) -> Array:
    """Least-squares joint velocity [rad/s], shape (n,), for a spatial velocity of the sole.

    Args:
        leg: the kinematic chain.
        theta: joint angles [rad]; joints at the end of their range do not move outward.
        V_PS_desired: [angular; translational] velocity of S in P, expressed in P, shape (6,) [rad/s, m/s].
        parameters: kind of the Jacobian.
    """
    parameters = parameters or InverseKinematicsParameters()
    J = ROW_WEIGHTS[:, None] * leg.jacobian(theta, parameters.jacobian)
    V = ROW_WEIGHTS * V_PS_desired

    def velocity_of(J: Array) -> Array:
        squares, U = np.linalg.eigh(J @ J.T)  # of the singular values; left singular vectors
        velocity: Array = J.T @ (U / np.maximum(squares, SINGULAR_VALUE_FLOOR**2) @ (U.T @ V))
        return velocity

    return _within_ranges(leg, theta, J, velocity_of)


def _within_ranges(leg: LegKinematics, theta: Array, J: Array, motion: Callable[[Array], Array]) -> Array:
    """Motion of the joints, shape (n,), in which no joint at the end of its range moves outward; those are held.

    Args:
        leg: the kinematic chain.
        theta: joint angles [rad].
        J: Jacobian, shape (6, n).
        motion: motion of the joints for a Jacobian; the columns of joints that are held are zero.
    """
    at_lower, at_upper = theta <= leg.lower, theta >= leg.upper
    result = motion(J)
    if not (at_lower | at_upper).any():
        return result
    free = np.ones(theta.size)
    while (outward := (at_lower & (result < 0)) | (at_upper & (result > 0))).any():
        free[outward] = 0.0
        result = free * motion(free * J)
    return result
