"""Integral action on joints with a PD law: what makes the law PID, and the bound up to which it is stable."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.control.pd_control import PD_LAWS, PdLaw, joint_update
from humanwalk.numerics import Array, Mask
from humanwalk.numerics.stability import largest_stable_step, round_up
from humanwalk.quantity import ParameterError


def integrated(torque: Array, error: Array, ki: Array, saturated: Mask, h: float) -> Array:
    """Integral torque after a step: z' = z + h ki e, but z' = z while the joint saturates.

    Conditional integration prevents windup (Astrom & Hagglund, PID Controllers: Theory, Design, and Tuning, 2nd ed.,
    1995, section 3.5).

    Args:
        torque: integral torque z [N m], shape (n,).
        error: desired minus actual angle e [rad], shape (n,).
        ki: integral gain [N m/(rad s)], shape (n,); kp / T_i for the integral time T_i.
        saturated: joints whose law reaches the effort limit, shape (n,).
        h: step [s].

    Returns:
        z' [N m], shape (n,).
    """
    return np.where(saturated, torque, torque + h * ki * error)


def integral_update(h: float, M: Array, kp: Array, kd: Array, law: PdLaw, ki: Array, kx: Array) -> Array:
    """Matrix of [q; v; z] -> [q'; v'; z'] for a PD law with an added torque z, linearized at rest.

    With the desired state at zero, z' = z - h (ki q + kx v), and z acts in the step that follows.

    Args:
        h: step [s].
        M: mass matrix, shape (m, m), floating base first; its last n rows are the joints.
        kp, kd: gains of the n joints.
        law: discretization of the PD law.
        ki, kx: gains of angle [N m/(rad s)] and rate [N m/rad] in z, shape (n,). Joints without ki have no z.

    Returns:
        Shape (2n + k, 2n + k), with the k joints that have ki.
    """
    base = len(M) - kp.size
    D = np.pad(PD_LAWS[law].impedance(h, kp, kd)[0], (base, 0))
    integral = np.eye(kp.size)[:, ki > 0]
    v_of_z = h * np.linalg.inv(M + np.diag(D))[base:, base:] @ integral
    return np.block(
        [
            [joint_update(h, M, kp, kd, law), np.concatenate((h * v_of_z, v_of_z))],
            [-h * integral.T @ np.diag(ki), -h * integral.T @ np.diag(kx), np.eye(integral.shape[1])],
        ]
    )


def require_stable_integral(
    plant: MultibodyPlant,
    kp: Array,
    kd: Array,
    law: PdLaw,
    field: str,
    time: float,
    gain: float = 1.0,
    rate_time: float = 0.0,
) -> None:
    """Raise ParameterError unless a plant is discrete and its step stable with an integral (at its default positions).

    Args:
        plant: finalized.
        kp, kd, law: of the PD law, which is stable at the plant's step.
        field: name of the integral time, for the message.
        time: the integral time [s].
        gain: integral gains are ki = gain kp / time.
        rate_time: gain of the rate over that of the angle in the integral [s].
    """
    h = plant.time_step()
    if h == 0:
        raise ParameterError(
            f"{field}: an integral needs the discrete plant; allowed: with simulation.integrator: discrete; set it "
            "and a time_step"
        )
    M = base_first_mass_matrix(plant)

    def update(rate: float) -> Array:
        return integral_update(h, M, kp, kd, law, rate * gain * kp, rate_time * rate * gain * kp)

    fastest = largest_stable_step(update, upper=1.0 / time)
    if fastest < 1.0 / time:
        raise ParameterError(
            f"{field}: {time:g} is unstable at time_step {h:g} s; allowed: {round_up(1.0 / fastest):g} s or longer "
            "with these gains; raise it"
        )
