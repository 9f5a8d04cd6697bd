"""The PD law of every joint (thesis Eq 4-23 with the sign of the damping corrected, E10), and its gains."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from humanwalk.body.limbs import group_of
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, quantity

THESIS_ANKLE = (10000.0, 10.0)
"""kp [N m/rad] and kd [N m s/rad] of the ankle: the only gains that the thesis prints (Fig 4.8)."""

STIFFNESS = {
    "hip": 20000.0,
    "knee": 10000.0,
    "ankle": 10000.0,
    "foot": 1000.0,
    "spine": 5000.0,
    "shoulder girdle": 1000.0,
    "neck": 300.0,
    "shoulder": 500.0,
    "elbow": 300.0,
    "wrist": 50.0,
}
"""kp [N m/rad] of the presets by the joint's group. Ankle: thesis. The rest is ours: the thesis prints no other."""


PdLaw = Literal["implicit", "semi_implicit", "explicit"]
"""Discretization of the law, see `humanwalk.control.pd_laws`."""


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
    """tau = kp (q_d - q) + kd (v_d - v) [N m], element-wise (Eq 4-23 corrected as in E10)."""
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

    kp = parameters.stiffness_scale * np.array([STIFFNESS[group_of(name)] for name in joint_names])
    kd = 2.0 * parameters.damping_ratio * np.sqrt(kp * joint_space_inertia)
    if parameters.preset == "thesis":
        ankle = np.array([group_of(name) == "ankle" for name in joint_names])
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
