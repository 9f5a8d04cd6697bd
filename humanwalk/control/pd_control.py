"""The PD law of the joints (thesis Eq 4-23 with the sign of the damping corrected, E10) and its discretizations."""

from collections.abc import Callable
from typing import Literal, Protocol

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex, PdControllerGains

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.numerics import Array
from humanwalk.numerics.stability import largest_stable_step, round_down
from humanwalk.quantity import ParameterError

PdLaw = Literal["implicit", "semi_implicit", "explicit"]
"""Name of a discretization, see `PD_LAWS`."""

StepImpedance = Callable[[float], tuple[Array, Array]]
"""Of a step h [s]: the diagonals of D and E of a law, shape (n,) each [kg m2]; see `PdDiscretization`."""


def pd_torque(q: Array, v: Array, q_desired: Array, v_desired: Array, kp: Array, kd: Array) -> Array:
    """tau = kp (q_d - q) + kd (v_d - v) [N m], element-wise (Eq 4-23 corrected as in E10)."""
    tau: Array = kp * (q_desired - q) + kd * (v_desired - v)
    return tau


class PdDiscretization(Protocol):
    """How the PD law acts in a time step of the plant.

    Linearized at rest, the step is (M + D) v' = (M - E) v - h kp q, q' = q + h v'.

    Attributes:
        takes_desired_state: whether the plant computes the law from its desired_state port.
        keeps_effort_limits: whether the plant's actuators keep their effort limits.
    """

    takes_desired_state: bool
    keeps_effort_limits: bool

    def install(self, plant: MultibodyPlant, actuator: JointActuatorIndex, kp: float, kd: float) -> None:
        """Give an actuator and its joint the part of the law that the plant computes; before Finalize."""

    def joint_damping(self, kd: Array) -> Array:
        """Part of kd that `install` adds to the damping of the joints [N m s/rad], shape (n,)."""

    def impedance(self, h: float, kp: Array, kd: Array) -> tuple[Array, Array]:
        """Diagonals of D and E at a step h [s], shape (n,) each [kg m2]."""


class ImplicitPd:
    """The plant's own PD: stable at any step; one solver constraint per joint."""

    takes_desired_state, keeps_effort_limits = True, True

    def install(self, plant: MultibodyPlant, actuator: JointActuatorIndex, kp: float, kd: float) -> None:
        plant.get_mutable_joint_actuator(actuator).set_controller_gains(PdControllerGains(p=kp, d=kd))

    def joint_damping(self, kd: Array) -> Array:
        return np.zeros_like(kd)

    def impedance(self, h: float, kp: Array, kd: Array) -> tuple[Array, Array]:
        return h * kd + h * h * kp, np.zeros_like(kd)


class SemiImplicitPd:
    """Damping as the joint's own, which the solver takes implicitly; stiffness and limits as torque.

    A joint at its effort limit receives up to kd times the change of its velocity in a step more than the limit.
    """

    takes_desired_state, keeps_effort_limits = False, False

    def install(self, plant: MultibodyPlant, actuator: JointActuatorIndex, kp: float, kd: float) -> None:
        joint = plant.get_mutable_joint(plant.get_joint_actuator(actuator).joint().index())
        joint.set_default_damping_vector(joint.default_damping_vector() + kd)
        # The plant would clip the torque without its damping.
        plant.get_mutable_joint_actuator(actuator).set_effort_limit(np.inf)

    def joint_damping(self, kd: Array) -> Array:
        return kd

    def impedance(self, h: float, kp: Array, kd: Array) -> tuple[Array, Array]:
        return h * kd, np.zeros_like(kd)


class ExplicitPd:
    """The whole law as torque: with the thesis' gains stable up to a tenth of a millisecond."""

    takes_desired_state, keeps_effort_limits = False, True

    def install(self, plant: MultibodyPlant, actuator: JointActuatorIndex, kp: float, kd: float) -> None:
        pass

    def joint_damping(self, kd: Array) -> Array:
        return np.zeros_like(kd)

    def impedance(self, h: float, kp: Array, kd: Array) -> tuple[Array, Array]:
        return np.zeros_like(kd), h * kd


PD_LAWS: dict[PdLaw, PdDiscretization] = {
    "implicit": ImplicitPd(),
    "semi_implicit": SemiImplicitPd(),
    "explicit": ExplicitPd(),
}


def install_gains(plant: MultibodyPlant, kp: Array, kd: Array, law: PdLaw = "implicit") -> None:
    """Give a plant the part of the law that it computes, for all n actuators in order; before Finalize.

    Args:
        plant: plant with n actuators.
        kp, kd: gains [N m/rad], [N m s/rad], shape (n,).
        law: discretization.
    """
    for i, (p, d) in enumerate(zip(kp, kd, strict=True)):
        PD_LAWS[law].install(plant, JointActuatorIndex(i), float(p), float(d))


def linear_update(h: float, M: Array, D: Array, E: Array, K: Array) -> Array:
    """Matrix of [q; v] -> [q'; v'] for (M + D) v' = (M - E) v - h K q, q' = q + h v'; shape (2m, 2m).

    Args:
        h: step [s].
        M: mass matrix, shape (m, m).
        D, E, K: diagonals, shape (m,).
    """
    eye, mobility = np.eye(len(M)), np.linalg.inv(M + np.diag(D))
    v_of_q, v_of_v = -h * mobility * K, eye - mobility * (D + E)
    return np.block([[eye + h * v_of_q, h * v_of_v], [v_of_q, v_of_v]])


def joint_update(h: float, M: Array, kp: Array, kd: Array, law: PdLaw) -> Array:
    """Matrix of [q; v] -> [q'; v'] for the n joints of a body with a PD law, linearized at rest; shape (2n, 2n).

    Args:
        h: step [s].
        M: mass matrix, shape (m, m), floating base first; its last n rows are the joints.
        kp, kd: gains of the n joints.
        law: discretization.
    """
    base = len(M) - kp.size
    D, E, K = (np.pad(diagonal, (base, 0)) for diagonal in (*PD_LAWS[law].impedance(h, kp, kd), kp))
    # No force depends on the base, so that its rows and columns add nothing but free motion.
    joints = np.flatnonzero(np.tile(np.arange(len(M)) >= base, 2))
    return linear_update(h, M, D, E, K)[np.ix_(joints, joints)]


def largest_pd_step(M: Array, kp: Array, kd: Array, law: PdLaw, upper: float = 0.1) -> float:
    """Largest step [s] at which a law is stable, linearized at rest.

    Args:
        M: mass matrix, shape (m, m), floating base first; its last n rows are the joints.
        kp, kd: gains of the n joints.
        law: discretization.
        upper: longest step that is considered [s].
    """
    return largest_stable_step(lambda h: joint_update(h, M, kp, kd, law), upper)


def require_stable(plant: MultibodyPlant, kp: Array, kd: Array, law: PdLaw) -> None:
    """Raise ParameterError if a law is unstable at the time step of a finalized plant (at its default positions)."""
    stable = largest_pd_step(base_first_mass_matrix(plant), kp, kd, law)
    if plant.time_step() > stable:
        raise ParameterError(
            f"law: {law} is unstable at time_step {plant.time_step():g} s; allowed: steps up to "
            f"{round_down(stable):g} s with these gains; use law: implicit, softer gains, or that step"
        )
