"""Inverse kinematics of one leg by Newton's method with least squares (thesis section 4.1).

The thesis solves J^T J dtheta = -J^T G for the residual G between the pose of the sole and its
desired pose. As printed that system is singular: a leg has seven joints for six rows, and rank five
with a straight knee (erratum E13). Here the step is taken by the Moore-Penrose inverse through an SVD,
damped in proportion to the residual, kept inside the joint ranges, and accepted only if it makes the
residual smaller; so a target out of reach gives the nearest pose, and says so.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from operator import mul
from typing import Literal, NamedTuple

import numpy as np
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant
from scipy.linalg.lapack import dgesdd, dgesv

from humanwalk.control.revolute_chain import ChainState, Pose, RevoluteChain, rotation_vector
from humanwalk.numerics import Array, Indices
from humanwalk.quantity import quantity

Vector6 = tuple[float, ...]
Angles = tuple[float, ...]
"""Joint angles [rad]: arrays as short as these take longer than plain numbers wherever no matrix is at hand."""

STEP_FRACTIONS = (1.0, 0.5, 0.25, 0.1, 0.03, 0.003)
"""Shares of a Newton step that are tried until one lessens the residual."""

STATIONARY_GAIN = 1e-6
"""Relative gain of a step below which the nearest pose counts as found."""

RANK_FLOOR = 1e-9
"""Singular value of the weighted J [m/rad] up to which a motion of the joints leaves the sole alone."""

WELL_CONDITIONED = 0.01
"""Singular value of the weighted J [m/rad] above which J J' is inverted, which is quicker than an SVD; nearly straight
legs need the SVD."""

RESTART_GAIN = 0.5
"""Share of the residual below which the pose found by a second start replaces the first: less would not be worth
a jump of the joints."""


@dataclass(frozen=True)
class InverseKinematicsParameters:
    """How the Newton iteration is run."""

    jacobian: Literal["analytic", "numeric"] = "analytic"
    """Drake's Jacobian, or central differences as in the thesis (section 1.4)."""

    tolerance: float = quantity(1e-6, "m, rad", 1e-10, 1e-2)
    """Norm of the residual at which a pose counts as reached (the thesis asks for exactly 0)."""

    max_iterations: int = quantity(50, "", 1, 1000)
    """Newton steps, accepted or not, before giving up."""

    orientation_weight: float = quantity(0.03, "m/rad", 1e-3, 10.0)
    """Length that one radian of wrong orientation counts as, where a target cannot be reached: less than the
    height of an ankle, which keeps the sole's position and lets its pitch give way."""

    damping: float = quantity(0.5, "1/rad", 0.0, 10.0)
    """Damping of a step per weighted residual (after Sugihara 2011): short steps far from the target and past
    singular postures, pure Newton steps near the target."""

    singular_value_floor: float = quantity(0.01, "m/rad", 0.0, 1.0)
    """Smaller singular values of the weighted J do not raise joint velocities any more."""

    neutral_pull: float = quantity(0.1, "", 0.0, 1.0)
    """Share of each angle that the first step takes back where that leaves the sole alone: seven joints for six
    rows have one motion to spare, which would drift away from cycle to cycle."""

    max_step: float = quantity(0.5, "rad", 1e-3, 3.2)
    """Longest change of any joint in one step: keeps the linearisation meaningful."""

    @cached_property
    def row_weights(self) -> Array:
        """Weights of the six rows of the residual [rotation; position]."""
        return np.repeat((self.orientation_weight, 1.0), 3)

    @cached_property
    def row_weights_column(self) -> Array:
        """The same, shape (6, 1)."""
        return self.row_weights[:, None]


class InverseKinematicsSolution(NamedTuple):
    """What the iteration ended with.

    Attributes:
        theta: joint angles [rad], shape (n,), inside the joint ranges.
        residual: norm of [rotation vector [rad]; position error [m]] at `theta`.
        iterations: Newton steps tried.
        converged: whether `residual` is within the tolerance; if not, `theta` is the nearest pose found.
    """

    theta: Array
    residual: float
    iterations: int
    converged: bool


class LegKinematics:
    """The chain from a base frame to a tip frame through revolute joints of a plant.

    Args:
        plant: a finalised plant, see `RevoluteChain.of`; joints that are not in `joint_names` stay at zero.
        base_frame: name of the frame P in which poses are measured.
        tip_frame: name of the frame S whose pose is wanted.
        joint_names: the chain's joints in the order of theta.
    """

    def __init__(self, plant: MultibodyPlant, base_frame: str, tip_frame: str, joint_names: Sequence[str]) -> None:
        self._chain = RevoluteChain.of(plant, base_frame, tip_frame, joint_names)
        joints = [plant.GetJointByName(name) for name in joint_names]
        self.joint_names = tuple(joint_names)
        self.lower = np.array([joint.position_lower_limits()[0] for joint in joints])
        self.upper = np.array([joint.position_upper_limits()[0] for joint in joints])
        self._ranges = tuple(zip(self.lower.tolist(), self.upper.tolist(), strict=True))
        # A pose is followed by its Jacobian.
        self._at = lru_cache(maxsize=1)(self._chain.at)

    def state(self, theta: Array | Angles) -> ChainState:
        """Where the chain is at n joint angles theta [rad]."""
        return self._at(theta if isinstance(theta, tuple) else tuple(theta.tolist()))

    def within_range(self, theta: Iterable[float]) -> Angles:
        """The nearest joint angles inside the joint ranges."""
        return tuple([min(max(angle, low), high) for angle, (low, high) in zip(theta, self._ranges, strict=True)])

    def off_ends(self, theta: Iterable[float]) -> bool:
        """Whether no joint is at an end of its range."""
        return all([low < angle < high for angle, (low, high) in zip(theta, self._ranges, strict=True)])

    def X_PS(self, theta: Array) -> RigidTransform:
        """Pose of the tip S in the base P at joint angles theta [rad], shape (n,)."""
        x, y, z, p = self.state(theta).X_PS
        return RigidTransform(RotationMatrix(np.array((x, y, z)).T), np.array(p))

    def Jv_V_PS(self, theta: Array) -> Array:
        """Jacobian of the spatial velocity (rotation first) of S in P, expressed in P; (6, n)."""
        return self.state(theta).jacobian()

    def Jv_V_PS_numeric(self, theta: Array, step: float = 1e-6) -> Array:
        """The same Jacobian by central differences, as the thesis calculates it (section 1.4)."""
        J = np.empty((6, theta.size))
        for i in range(theta.size):
            ahead, behind = theta.copy(), theta.copy()
            ahead[i] += step
            behind[i] -= step
            J[:, i] = pose_error(self.X_PS(ahead), self.X_PS(behind)) / (2 * step)
        return J

    def jacobian(self, theta: Array | Angles, kind: Literal["analytic", "numeric"]) -> Array:
        """The Jacobian of the named kind, shape (6, n)."""
        return self.state(theta).jacobian() if kind == "analytic" else self.Jv_V_PS_numeric(np.array(theta))


def pose_error(X: RigidTransform, X_desired: RigidTransform) -> Array:
    """[rotation vector; translation] that leads from X_desired to X, in their common frame; (6,).

    The rotation vector replaces the thesis' difference of Euler angles (Eq 4-3), which jumps at +-pi (E13).
    """
    return np.array(_pose_error(_axes_and_origin(X), _axes_and_origin(X_desired)))


def _axes_and_origin(X: RigidTransform) -> Pose:
    # One number after the other crosses from C++ into Python at a price; the matrix crosses whole.
    x, y, z, p = X.GetAsMatrix34().T.tolist()
    return x, y, z, p


def _pose_error(X: Pose, X_desired: Pose) -> Vector6:
    (a, b, c), (d, e, f) = X[3], X_desired[3]
    return *rotation_vector(X_desired[:3], X[:3]), a - d, b - e, c - f


def solve_inverse_kinematics(
    leg: LegKinematics,
    X_PS_desired: RigidTransform | Pose,
    theta_guess: Array,
    parameters: InverseKinematicsParameters | None = None,
) -> InverseKinematicsSolution:
    """Joint angles that bring the leg's sole to a desired pose (thesis Eq 4-3 to 4-5).

    Args:
        leg: the kinematic chain, n joints.
        X_PS_desired: desired pose of the sole S in the pelvis P.
        theta_guess: warm start [rad], shape (n,); brought into the joint ranges first.
        parameters: the iteration's settings.

    Returns:
        The pose found. Joints at the end of their range and a straight leg can stall the iteration short of a pose
        that is within reach, so one that stalls is tried once more with those joints in the middle of their ranges.
    """
    parameters = parameters or InverseKinematicsParameters()
    desired = _axes_and_origin(X_PS_desired) if isinstance(X_PS_desired, RigidTransform) else X_PS_desired
    first, first_cost = _iterate(leg, desired, theta_guess, parameters)
    if first.converged:
        return first
    at_end = (first.theta <= leg.lower) | (first.theta >= leg.upper)
    restart = np.where(at_end, 0.5 * (leg.lower + leg.upper), first.theta)
    second, second_cost = _iterate(leg, desired, restart, parameters)
    better = second.converged or second_cost < RESTART_GAIN * first_cost
    return (second if better else first)._replace(iterations=first.iterations + second.iterations)


def _iterate(
    leg: LegKinematics,
    desired: Pose,
    theta_guess: Array,
    parameters: InverseKinematicsParameters,
) -> tuple[InverseKinematicsSolution, float]:
    """Newton steps until nothing improves; the solution and the norm of its weighted residual."""
    weights = parameters.row_weights.tolist()

    def at(theta: Angles) -> tuple[Vector6, Vector6, float]:
        """Residual, weighted residual and its norm."""
        error = _pose_error(leg.state(theta).X_PS, desired)
        weighted = tuple(map(mul, weights, error))
        return error, weighted, math.hypot(*weighted)

    theta = leg.within_range(theta_guess.tolist())
    error, weighted, cost = at(theta)
    iterations, pull = 0, parameters.neutral_pull
    while math.hypot(*error) > parameters.tolerance and iterations < parameters.max_iterations:
        iterations += 1
        J = leg.jacobian(theta, parameters.jacobian) * parameters.row_weights_column
        step = _newton_step(leg, theta, J, np.array(weighted), parameters.damping * cost, pull).tolist()
        longest = max(map(abs, step))
        shorter = parameters.max_step / longest if longest > parameters.max_step else 1.0
        # Shorten the step until it helps: far targets and joints at the end of their range bend the residual.
        for fraction in STEP_FRACTIONS:
            trial = leg.within_range(
                [angle + fraction * (shorter * way) for angle, way in zip(theta, step, strict=True)]
            )
            trial_error, trial_weighted, trial_cost = at(trial)
            if trial_cost < cost:
                break
        gain = cost - trial_cost
        if gain > 0:
            theta, error, weighted, cost = trial, trial_error, trial_weighted, trial_cost
        # A step with the pull in it says nothing about what a pure Newton step would gain.
        if gain < STATIONARY_GAIN * cost and not pull:
            break
        pull = 0.0
    residual = math.hypot(*error)
    return InverseKinematicsSolution(np.array(theta), residual, iterations, residual <= parameters.tolerance), cost


def _newton_step(leg: LegKinematics, theta: Angles, J: Array, error: Array, damping: float, pull: float) -> Array:
    """Step -J+ error - (1 - J+ J) pull theta of the joints that are free to move, J+ damped; shape (n,)."""

    def step_of(free: Indices | slice) -> Array:
        Jf = J[:, free]
        square = Jf.dot(Jf.T)
        damped = square + damping * damping * _IDENTITY
        inverse = _inverse(square if pull else damped, WELL_CONDITIONED)
        step: Array
        if inverse is not None and not pull:
            step = -inverse.dot(error).dot(Jf)
            return step
        if inverse is not None:
            # What is damped is no nearer to singular.
            *_, wanted, _ = dgesv(damped, error)
            back = pull * np.array(theta)[free]
            step = (inverse.dot(Jf.dot(back)) - wanted).dot(Jf) - back
            return step
        U, s, Vt, _ = dgesdd(Jf)
        # The tiny constant keeps a posture that is exactly singular from dividing by zero.
        along = (Vt[: s.size].T * (s / (s * s + damping * damping + 1e-30))) @ U.T[: s.size]
        spare = Vt[np.count_nonzero(s > RANK_FLOOR) :]
        step = -along @ error - pull * spare.T @ (spare @ np.array(theta)[free])
        return step

    return _of_free_joints(leg, theta, step_of)


def _inverse(square: Array, least: float) -> Array | None:
    """The inverse of J J', or None where J may have a singular value of `least` or below."""
    *_, inverse, singular = dgesv(square, _IDENTITY)
    if singular:
        return None
    # The inverse's Frobenius norm is no less than the inverse square of the least singular value.
    entries = inverse.ravel(order="K")
    return inverse if entries.dot(entries) < least**-4 else None


_IDENTITY = np.eye(6)


def _of_free_joints(leg: LegKinematics, theta: Angles, motion: Callable[[Indices | slice], Array]) -> Array:
    """A motion of the joints, shape (n,), in which none at the end of its range moves outward: those are held.

    Args:
        leg: the kinematic chain.
        theta: joint angles [rad].
        motion: gives the motion of the joints with the given places, when all others are held.
    """
    result = motion(slice(None))
    if leg.off_ends(theta):
        return result
    at_lower, at_upper = theta <= leg.lower, theta >= leg.upper
    free = np.arange(len(theta))
    while True:
        outward = (at_lower & (result < 0)) | (at_upper & (result > 0))
        if not outward.any():
            return result
        free = np.setdiff1d(free, np.flatnonzero(outward))
        result = np.zeros(len(theta))
        if free.size:
            result[free] = motion(free)


def joint_velocity(
    leg: LegKinematics,
    theta: Array,
    V_PS_desired: Array,
    parameters: InverseKinematicsParameters | None = None,
) -> Array:
    """Least-squares joint velocity [rad/s], shape (n,), for a spatial velocity of the sole.

    Args:
        leg: the kinematic chain.
        theta: joint angles [rad] at which it is wanted; joints at the end of their range do not move outward.
        V_PS_desired: [angular; translational] velocity of S in P, expressed in P, shape (6,) [rad/s, m/s].
        parameters: weights, and the floor that keeps the velocity finite near singular postures.
    """
    parameters = parameters or InverseKinematicsParameters()
    weighted, angles = parameters.row_weights * V_PS_desired, tuple(theta.tolist())
    J = leg.jacobian(angles, parameters.jacobian) * parameters.row_weights_column

    def velocity_of(free: Indices | slice) -> Array:
        Jf, floor = J[:, free], max(parameters.singular_value_floor, RANK_FLOOR)
        direct = _inverse(Jf.dot(Jf.T), max(floor, WELL_CONDITIONED))
        if direct is not None:
            return np.asarray(direct.dot(weighted).dot(Jf))
        U, s, Vt, _ = dgesdd(Jf, full_matrices=0)
        inverse = s / np.maximum(s, floor) ** 2
        velocity: Array = (Vt.T * inverse) @ (U.T @ weighted)
        return velocity

    return _of_free_joints(leg, angles, velocity_of)
