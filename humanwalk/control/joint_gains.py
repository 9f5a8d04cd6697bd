"""PD gains of the joints: what the thesis prints of them, and presets for the rest."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import group_of
from humanwalk.body_units import REFERENCE_BODY, BodyScale
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, near_or_all, quantity

THESIS_ANKLE = (10000.0, 10.0)
"""kp [N m/rad] and kd [N m s/rad] of the ankle: the only gains that the thesis prints (Fig 4.8)."""

STIFFNESS_BY_GROUP = {
    "hip": 20000.0,
    "knee": 10000.0,
    "ankle": THESIS_ANKLE[0],
    "foot": 1000.0,
    "spine": 5000.0,
    "shoulder girdle": 1000.0,
    "neck": 300.0,
    "shoulder": 500.0,
    "elbow": 300.0,
    "wrist": 50.0,
}
"""kp [N m/rad] of the presets by group of joints, for the reference body; all but the ankle's are our choice."""


@dataclass(frozen=True)
class PdGains:
    """Gains of one joint."""

    kp: float = quantity(0.0, "N m/rad", 0.0, 1e6)
    """Torque per error of the angle."""

    kd: float = quantity(0.0, "N m s/rad", 0.0, 1e5)
    """Torque per error of the rate."""


@dataclass(frozen=True)
class JointGains:
    """PD gains of all joints, for the reference body; they scale with the subject."""

    preset: Literal["thesis", "damped"] = "thesis"
    """`damped`: kd from `damping_ratio` and the joint-space inertia; `thesis`: that, but the ankles at 10000/10."""

    damping_ratio: float = quantity(1.0, "", 0.0, 10.0)
    """Damping ratio of each joint alone, with its joint-space inertia in neutral standing."""

    stiffness_scale: float = quantity(1.0, "", 0.01, 100.0)
    """Factor on every kp of the presets (not on those of `joints`)."""

    joints: Mapping[str, PdGains] = field(default_factory=dict)
    """Gains of single joints by name; they replace the preset's."""


def joint_gains(
    model: MultibodyPlant, parameters: JointGains, scale: BodyScale = REFERENCE_BODY
) -> tuple[Array, Array]:
    """kp [N m/rad] and kd [N m s/rad] of all joints in actuator order, shape (n,) each.

    Args:
        model: finalized plant of the body.
        parameters: preset and single joints.
        scale: from the reference body to this one.

    Raises:
        ParameterError: `joints` names no joint of the body.
    """
    joints = JointMap.of(model)
    inertia = model.CalcMassMatrix(model.CreateDefaultContext()).diagonal()[joints.v]
    groups = [group_of(name) for name in joints.names]
    unit = np.array((scale.factor("N m/rad"), scale.factor("N m s/rad")))
    kp = parameters.stiffness_scale * np.array([STIFFNESS_BY_GROUP[group] for group in groups]) * unit[0]
    kd = 2.0 * parameters.damping_ratio * np.sqrt(kp * inertia)
    if parameters.preset == "thesis":
        ankle = np.array([group == "ankle" for group in groups])
        kp[ankle], kd[ankle] = THESIS_ANKLE * unit
    for name, gains in parameters.joints.items():
        if name not in joints.names:
            raise ParameterError(
                f"gains.joints.{name}: no such joint; allowed: the {len(joints.names)} joints of the body"
                f"{near_or_all(name, joints.names)}"
            )
        i = joints.names.index(name)
        kp[i], kd[i] = (gains.kp, gains.kd) * unit
    return kp, kd
