"""The PD law of every joint (thesis Eq 4-23 with the damping's sign mended, E10), its gains and its stability."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from humanwalk.numerics import Array
from humanwalk.numerics.stability import largest_stable_step
from humanwalk.quantity import ParameterError, quantity

THESIS_ANKLE = (10000.0, 10.0)
"""kp [N m/rad] and kd [N m s/rad] of the ankle: the only gains that the thesis prints (Fig 4.8)."""

STIFFNESS_BY_JOINT_KIND = {
    "Femur": 20000.0,
    "Tibia": 10000.0,
    "Ankle": 10000.0,
    "Foot": 1000.0,
    "Lumbar": 5000.0,
    "Thoracic": 5000.0,
    "Scapula": 1000.0,
    "Cervical": 300.0,
    "Head": 300.0,
    "Shoulder": 500.0,
    "Elbow": 300.0,
    "Wrist": 50.0,
}
"""kp [N m/rad] by the word in a joint's name. Ankle: thesis. The rest is ours: the thesis prints no other."""


PdLaw = Literal["implicit", "semi_implicit", "explicit"]
"""Three ways to the same torque.

implicit: the plant's own PD through its desired_state port: stable at any step, at the price of one solver constraint
    for each joint.
semi_implicit: kd as the plant's joint damping, which its solver takes implicitly for nothing, and the rest as torque
    through the actuation port: a third quicker, stable at steps of several ms. A joint at its effort limit feels
    up to kd times a step's change of velocity more.
explicit: everything as torque: with the thesis' gains stable to a tenth of a millisecond only.
"""


@dataclass(frozen=True)
class PdGains:
    """Gains of one joint."""

    kp: float = quantity(0.0, "N m/rad", 0.0, 1e6)
    kd: float = quantity(0.0, "N m s/rad", 0.0, 1e5)


@dataclass(frozen=True)
class ActuatorParameters:
    """How the 42 joints follow their desired angles."""

    preset: Literal["thesis", "damped"] = "thesis"
    """`damped`: kd from `damping_ratio` and the joint-space inertia; `thesis`: that, but the ankles at 10000/10."""

    law: PdLaw = "implicit"
    """How the plant is given the law; see PdLaw."""

    damping_ratio: float = quantity(1.0, "", 0.0, 10.0)
    """Of each joint's own oscillation against its joint-space inertia in neutral standing."""

    stiffness_scale: float = quantity(1.0, "", 0.01, 100.0)
    """Multiplies every kp of the presets (not those named in `gains`)."""

    effort_limits: Literal["human", "none"] = "human"
    """Saturate at the body's effort limits, or at nothing, as in the thesis."""

    gains: Mapping[str, PdGains] = field(default_factory=dict)
    """Gains of single joints by name; they override the preset."""


def pd_torque(q: Array, v: Array, q_desired: Array, v_desired: Array, kp: Array, kd: Array) -> Array:
    """tau = kp (q_d - q) + kd (v_d - v) [N m], element-wise (Eq 4-23 mended as in E10)."""
    tau: Array = kp * (q_desired - q) + kd * (v_desired - v)
    return tau


def joint_gains(
    joint_names: Sequence[str],
    joint_space_inertia: Array,
    parameters: ActuatorParameters,
) -> tuple[Array, Array]:
    """Gains kp [N m/rad] and kd [N m s/rad] of all joints, shape (n,) each.

    Args:
        joint_names: the n joints in actuator order.
        joint_space_inertia: diagonal of the mass matrix for these joints [kg m2], shape (n,).
        parameters: preset and overrides.

    Raises:
        ParameterError: an override names no joint of the body.
    """
    import difflib

    kp = parameters.stiffness_scale * np.array([preset_stiffness(name) for name in joint_names])
    kd = 2.0 * parameters.damping_ratio * np.sqrt(kp * joint_space_inertia)
    if parameters.preset == "thesis":
        ankle = np.array([is_ankle(name) for name in joint_names])
        kp[ankle], kd[ankle] = THESIS_ANKLE
    for name, gains in parameters.gains.items():
        if name not in joint_names:
            near = difflib.get_close_matches(name, joint_names, n=1, cutoff=0.0)[0]
            raise ParameterError(
                f"actuators.gains.{name}: no such joint; allowed: the {len(joint_names)} joints "
                f"of the body; did you mean {near}?"
            )
        i = list(joint_names).index(name)
        kp[i], kd[i] = gains.kp, gains.kd
    return kp, kd


def is_ankle(joint_name: str) -> bool:
    """Whether a joint is one of the three ankle joints of a leg."""
    return "LegAnkle" in joint_name


def preset_stiffness(joint_name: str) -> float:
    """kp [N m/rad] of the presets for a joint of the body."""
    for word, kp in STIFFNESS_BY_JOINT_KIND.items():
        if word in joint_name:
            return kp
    raise ParameterError(f"{joint_name}: no preset stiffness; give its gains in actuators.gains")


def largest_explicit_step(M: Array, kp: Array, kd: Array, upper: float = 0.1) -> float:
    """Largest step [s] at which the explicit law is stable, linearised at rest.

    The plant's discrete update is v' = v + h M^-1 tau(q, v), q' = q + h v'.

    Args:
        M: mass matrix, shape (m, m), floating base first; its last n rows are the joints.
        kp, kd: gains of the n joints.
        upper: step beyond which nothing is looked for [s].
    """
    n, m = kp.size, M.shape[0]
    inverse = np.linalg.inv(M)[:, m - n :]
    K, D = inverse[m - n :] * kp, inverse[m - n :] * kd
    eye = np.eye(n)
    return largest_stable_step(lambda h: np.block([[eye - h * h * K, h * (eye - h * D)], [-h * K, eye - h * D]]), upper)


def largest_semi_implicit_step(M: Array, kp: Array, kd: Array, upper: float = 0.1) -> float:
    """Largest step [s] at which explicit stiffness with implicit damping is stable, linearised at rest.

    (M + h kd) v' = M v - h kp q, q' = q + h v'.

    Args:
        M: mass matrix, shape (m, m), floating base first; its last n rows are the joints.
        kp, kd: gains of the n joints.
        upper: step beyond which nothing is looked for [s].
    """
    n, m = kp.size, M.shape[0]
    eye = np.eye(n)

    def update(h: float) -> Array:
        damped = M.copy()
        damped[range(m - n, m), range(m - n, m)] += h * kd
        solved = np.linalg.inv(damped)
        # The base follows without a force of its own, so only the joints' rows feed back; its momentum stays zero.
        v_of_q = -h * solved[m - n :, m - n :] * kp
        v_of_v = eye - h * solved[m - n :, m - n :] * kd
        return np.block([[eye + h * v_of_q, h * v_of_v], [v_of_q, v_of_v]])

    return largest_stable_step(update, upper)
