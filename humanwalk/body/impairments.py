"""Impairments: changes of joints and lengths of a healthy skeleton.

Each kind is a frozen dataclass that returns the skeleton with the impairment. `known` tells whether the walker's own
model of its body, and with it torque limits and joint ranges of its controller, includes the impairment.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Literal, Protocol

import numpy as np

from humanwalk.body.limbs import ARMS, LEGS, Arm, Leg
from humanwalk.body.shapes import Measured, Vector3
from humanwalk.body.skeleton import Joint, Segment, Skeleton
from humanwalk.quantity import ParameterError, quantity
from humanwalk.sides import SIDES, Side

Sides = Literal["Right", "Left", "Both"]

JointRole = Literal[
    "hip_flexion",
    "hip_abduction",
    "hip_rotation",
    "knee",
    "ankle",
    "ankle_inversion",
    "ankle_rotation",
    "midfoot",
    "toes",
    "shoulder_flexion",
    "shoulder_abduction",
    "shoulder_rotation",
    "elbow",
    "wrist",
]
"""Attributes of `Leg` and `Arm` that are joints."""

NO_TORQUE = 1e-6
"""Torque limit of a joint without muscles [N m]: Drake's actuators have one above 0."""


class Impairment(Protocol):
    """One kind of impairment."""

    @property
    def known(self) -> bool:
        """Whether the walker's model of its body includes the impairment."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        """Return a skeleton with the impairment.

        Raises:
            ParameterError: The body cannot have it.
        """


@dataclass(frozen=True)
class JointImpairment:
    """Any joint of leg or arm: a smaller range of motion, less strength, passive stiffness."""

    joint: JointRole = "knee"
    """Joint; angles are positive in the direction of its name, at the knee in flexion, at the ankle in dorsiflexion."""

    side: Sides = "Right"
    """Side of the body."""

    lower: float = quantity(-math.pi, "rad", -math.pi, math.pi)
    """Lower end of the range of motion, if it is above the healthy one."""

    upper: float = quantity(math.pi, "rad", -math.pi, math.pi)
    """Upper end of the range of motion, if it is below the healthy one."""

    strength: float = quantity(1.0, "", 0.0, 1.0)
    """Factor on the torque limit, in both directions."""

    stiffness: float = quantity(0.0, "N m/rad", 0.0, 1000.0)
    """Passive stiffness."""

    rest_angle: float = quantity(0.0, "rad", -math.pi, math.pi)
    """Angle at which the passive torque is 0."""

    damping: float = quantity(0.0, "N m s/rad", 0.0, 100.0)
    """Passive damping in addition to the healthy one."""

    known: bool = True
    """Whether the walker's model of its body includes the impairment."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        names = {getattr(limb, self.joint) for limb in limbs_of(self.side, _LIMBS[self.joint])}
        return with_joints(skeleton, names, self._impaired)

    def _impaired(self, joint: Joint) -> Joint:
        low, high = max(self.lower, joint.range_rad[0]), min(self.upper, joint.range_rad[1])
        if low > high:
            healthy_low, healthy_high = joint.range_rad
            raise ParameterError(
                f"lower: {self.joint} has no range between {self.lower:.4g} and {self.upper:.4g} rad; allowed: a part "
                f"of its healthy range, {healthy_low:.4g} to {healthy_high:.4g} rad; change lower or upper"
            )
        # Two springs on one joint add up to one.
        stiffness = joint.stiffness + self.stiffness
        moment = joint.stiffness * joint.rest_angle + self.stiffness * self.rest_angle
        return replace(
            joint,
            range_rad=(low, high),
            effort_limit_N_m=max(self.strength * joint.effort_limit_N_m, NO_TORQUE),
            stiffness=stiffness,
            rest_angle=moment / stiffness if stiffness else 0.0,
            damping=joint.damping + self.damping,
        )


@dataclass(frozen=True)
class StiffKnee:
    """A knee that moves little or not at all: arthrodesis, orthosis, spasticity."""

    angle: float = quantity(math.radians(10.0), "rad", 0.0, 1.5)
    """Flexion in the middle of the remaining range."""

    play: float = quantity(0.0005, "rad", 0.0005, 1.0)
    """Remaining range to either side; up to 0.01 rad the knee is locked, and its structure carries the torque."""

    side: Sides = "Right"
    """Side of the body."""

    known: bool = True
    """Whether the walker's model of its body includes the impairment."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        lower, upper = self.angle - self.play, self.angle + self.play
        return JointImpairment("knee", self.side, lower, upper).applied(skeleton)


@dataclass(frozen=True)
class WeakPlantarflexors:
    """Calf muscles of less strength.

    The model has one torque limit for both directions of the ankle; what is left for dorsiflexion is several times what
    walking needs.
    """

    strength: float = quantity(0.5, "", 0.0, 1.0)
    """Factor on the torque limit of the ankle."""

    side: Sides = "Both"
    """Side of the body."""

    known: bool = True
    """Whether the walker's model of its body includes the impairment."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        return JointImpairment("ankle", self.side, strength=self.strength).applied(skeleton)


@dataclass(frozen=True)
class HipContracture:
    """A hip that cannot be extended."""

    angle: float = quantity(math.radians(10.0), "rad", -0.5, 1.0)
    """Least flexion."""

    stiffness: float = quantity(0.0, "N m/rad", 0.0, 1000.0)
    """Passive stiffness of flexion about `rest_angle`."""

    rest_angle: float = quantity(math.radians(20.0), "rad", -0.5, 1.5)
    """Flexion at which the passive torque is 0."""

    side: Sides = "Right"
    """Side of the body."""

    known: bool = True
    """Whether the walker's model of its body includes the impairment."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        joint = JointImpairment(
            "hip_flexion", self.side, lower=self.angle, stiffness=self.stiffness, rest_angle=self.rest_angle
        )
        return joint.applied(skeleton)


@dataclass(frozen=True)
class ShortLeg:
    """A leg with a shorter shank; mass and size of the shank are in proportion to its length.

    Joints and observers refer to the feet where they are, so that the walker's model always includes it.
    """

    shortening: float = quantity(0.03, "m", 0.001, 0.12)
    """Length by which the shank is shorter."""

    side: Side = "Right"
    """Side of the body."""

    @property
    def known(self) -> bool:
        return True

    def applied(self, skeleton: Skeleton) -> Skeleton:
        leg = LEGS[self.side]
        shank, ankle = skeleton.segment(leg.shank), skeleton.joint(leg.ankle)
        length = -ankle.origin[2]
        if self.shortening > 0.5 * length:
            raise ParameterError(
                f"shortening: {self.shortening:g} m is too much for a shank of {length:.3g} m; allowed: up to its "
                f"half, {0.5 * length:.3g} m; lower it"
            )
        ratio = 1.0 - self.shortening / length
        size, com = shank.proportions, shank.com
        shorter = replace(
            shank,
            shape=_along_z(shank, ratio),
            mass=ratio * shank.mass,
            com=(com[0], com[1], ratio * com[2]),
            proportions=(size[0], size[1], ratio * size[2]),
        )
        on_shank = {joint.name for joint in skeleton.joints if joint.parent == leg.shank}
        raised = [
            height + self.shortening * (side == self.side) for side, height in zip(SIDES, skeleton.raised, strict=True)
        ]
        lowest = min(raised)
        shortened = with_joints(skeleton, on_shank, lambda joint: replace(joint, origin=_raised(joint.origin, ratio)))
        # The longer leg stands on the ground.
        return replace(
            shortened,
            segments=tuple(shorter if segment == shank else segment for segment in skeleton.segments),
            root_height=skeleton.root_height - lowest,
            raised=(raised[0] - lowest, raised[1] - lowest),
        )


IMPAIRMENTS: dict[str, type[Impairment]] = {
    "stiff_knee": StiffKnee,
    "weak_plantarflexors": WeakPlantarflexors,
    "hip_contracture": HipContracture,
    "short_leg": ShortLeg,
    "joint": JointImpairment,
}
"""The impairments that a scenario can name."""


def limbs_of[Limb](side: Sides, limbs: Mapping[Side, Limb]) -> list[Limb]:
    """Return the limbs of a side, or of both."""
    return [limb for of_side, limb in limbs.items() if side in (of_side, "Both")]


def with_joints(skeleton: Skeleton, names: Iterable[str], change: Callable[[Joint], Joint]) -> Skeleton:
    """Return a skeleton with some of its joints changed."""
    changed = set(names)
    joints = tuple(change(joint) if joint.name in changed else joint for joint in skeleton.joints)
    return replace(skeleton, joints=joints)


_LIMBS: dict[str, Mapping[Side, Leg | Arm]] = {
    **{field.name: LEGS for field in fields(Leg)},
    **{field.name: ARMS for field in fields(Arm) if field.name != "side"},
}


def _raised(origin: Vector3, ratio: float) -> Vector3:
    return (origin[0], origin[1], ratio * origin[2])


def _along_z(segment: Segment, ratio: float) -> Measured:
    """The mass distribution of a shank, shorter along z."""
    x, y, z = segment.shape.extent.tolist()
    kx, ky, kz = np.sqrt(segment.inertia / segment.mass).tolist()
    return Measured((x, y, ratio * z), (ratio * kx, ratio * ky, kz))
