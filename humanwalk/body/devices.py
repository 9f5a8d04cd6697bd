"""Devices that replace or assist a part of the body: an ankle prosthesis, exoskeletons.

Each kind is a frozen dataclass that returns the skeleton with the device. `known` tells whether the walker's own model
of its body includes the device; of an exoskeleton that is mass and torque.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

from humanwalk.body.impairments import NO_TORQUE, Sides, limbs_of, with_joints
from humanwalk.body.limbs import LEGS, Leg
from humanwalk.body.shapes import Cylinder, Vector3
from humanwalk.body.skeleton import Joint, Segment, Skeleton, Weld
from humanwalk.body.visual import Color, Visual, ball, capsule
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, quantity
from humanwalk.sides import OUTWARD, Side

SOCKET: Color = (0.80, 0.79, 0.75)
METAL: Color = (0.55, 0.57, 0.60)
CARBON: Color = (0.12, 0.12, 0.13)
CUFF: Color = (0.16, 0.38, 0.34)

NATURAL_SHANK = ("lower_shank", "lower_shank_stripe", "hem", "hem_stripe", "ankle")
"""Parts of the look that a pylon replaces."""

PLAY = 0.0005
"""Range to either side of the joints that a prosthetic foot does not have [rad]."""

SIDE_DAMPING = 5.0
"""Damping of inversion [N m s/rad] (our choice)."""

TOE_DAMPING = 0.3
"""Damping of flexible toes [N m s/rad] (our choice)."""

CENTER_RATIO = 0.75
"""Distance of the center of mass of stump, socket and pylon below the knee, relative to a natural shank: the pylon is
light (our choice)."""


@dataclass(frozen=True)
class Assistance:
    """A torque on one joint over the gait cycle of one foot.

    Attributes:
        side: The foot whose touchdown begins the cycle.
        joint: Name of the joint.
        peak: Greatest torque, in the joint's positive direction [N m].
        peak_phase, rise, fall: Phase of the peak, and shares of the cycle in which the torque rises and falls.
        known: Whether the walker's model includes it.
    """

    side: Side
    joint: str
    peak: float
    peak_phase: float
    rise: float
    fall: float
    known: bool

    def torque(self, phase: float) -> float:
        """Return the torque [N m] at a phase of the gait cycle, 0 at touchdown and 1 at the next one."""
        # Distance from the peak, that of the nearest cycle.
        after = (phase - self.peak_phase + 0.5) % 1.0 - 0.5
        s = clip(1.0 - (after / self.fall if after > 0.0 else -after / self.rise), 0.0, 1.0)
        return self.peak * s * s * (3.0 - 2.0 * s)


class Device(Protocol):
    """One kind of device."""

    @property
    def known(self) -> bool:
        """Whether the walker's model of its body includes the device."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        """Return a skeleton that wears the device."""

    def assistance(self) -> Iterator[Assistance]:
        """Yield the torques of the device."""


@dataclass(frozen=True)
class AnkleProsthesis:
    """A passive foot on a pylon below the knee: spring and damper instead of the muscles of ankle and foot.

    Its ankle gives way in flexion and inversion, and its toes are flexible; it has no other joints.
    """

    stiffness: float = quantity(220.0, "N m/rad", 50.0, 1500.0)
    """Stiffness of the ankle in flexion, found by simulation; human ankles in stance have about 5 N m/rad per kg
    (Shamaei et al. 2013, from memory)."""

    damping: float = quantity(15.0, "N m s/rad", 0.0, 100.0)
    """Damping of the ankle in flexion (our choice)."""

    rest_angle: float = quantity(0.12, "rad", -0.3, 0.3)
    """Dorsiflexion at which the spring is relaxed: aligned for the bent knees of the balanced walker (our choice)."""

    side_stiffness: float = quantity(80.0, "N m/rad", 20.0, 1500.0)
    """Stiffness of the ankle in inversion: of multiaxial foot, socket and shoe together, found by simulation. A rigid
    one would hold the hips in place in double support."""

    toe_stiffness: float = quantity(30.0, "N m/rad", 5.0, 500.0)
    """Stiffness of the flexible toes (our choice)."""

    shank_mass: float = quantity(2.0, "kg", 0.3, 10.0)
    """Mass of stump, socket and pylon; a natural shank of the reference human has 3.08 kg."""

    foot_mass: float = quantity(0.8, "kg", 0.2, 5.0)
    """Mass of prosthetic foot and shoe; a natural foot of the reference human has 1.26 kg."""

    side: Side = "Right"
    """Side of the body."""

    known: bool = True
    """Whether the walker's model of its body includes the device."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        leg = LEGS[self.side]
        shank = skeleton.segment(leg.shank)
        if shank.hidden:
            raise ParameterError(
                f"side: the {self.side.lower()} leg already has a prosthesis; allowed: one on each; remove one device"
            )
        foot = [segment for segment in skeleton.segments if _hangs_on(skeleton, segment, shank)]
        lighter = self.foot_mass / sum(segment.mass for segment in foot)
        x, y, z = shank.com
        changed = {segment.name: replace(segment, mass=lighter * segment.mass) for segment in foot}
        changed[shank.name] = replace(
            shank,
            mass=self.shank_mass,
            com=(x, y, CENTER_RATIO * z),
            hidden=NATURAL_SHANK,
            drawn=(*shank.drawn, *self._drawn(skeleton, leg)),
        )
        rigid: dict[str, Any] = {"effort_limit_N_m": NO_TORQUE, "range_rad": (-PLAY, PLAY)}
        changes = {joint: rigid for joint in (leg.ankle_rotation, leg.midfoot)}
        changes[leg.ankle] = _spring(self.stiffness, self.damping, self.rest_angle)
        changes[leg.ankle_inversion] = _spring(self.side_stiffness, SIDE_DAMPING)
        changes[leg.toes] = _spring(self.toe_stiffness, TOE_DAMPING)
        return replace(
            with_joints(skeleton, changes, lambda joint: replace(joint, **changes[joint.name])),
            segments=tuple(changed.get(segment.name, segment) for segment in skeleton.segments),
        )

    def assistance(self) -> Iterator[Assistance]:
        return iter(())

    def _drawn(self, skeleton: Skeleton, leg: Leg) -> Iterator[Visual]:
        """Socket and pylon."""
        girth, _, up = skeleton.size(leg.shank)
        ankle = skeleton.joint(leg.ankle).origin
        end = 0.52 * ankle[2]
        yield capsule(leg.shank, "socket", (0.0, 0.0, -0.10 * up), (-0.003, 0.0, end), 0.054 * girth, SOCKET)
        yield ball(leg.shank, "adapter", (-0.002, 0.0, end - 0.055 * girth), 0.030 * girth, METAL)
        yield capsule(leg.shank, "pylon", (-0.002, 0.0, end - 0.05 * girth), ankle, 0.016 * girth, METAL)
        yield ball(leg.shank, "clamp", ankle, 0.028 * girth, CARBON)


@dataclass(frozen=True)
class AnkleExoskeleton:
    """Assists plantarflexion before toe-off."""

    peak_torque: float = quantity(20.0, "N m", -100.0, 100.0)
    """Greatest torque in plantarflexion; negative values oppose it."""

    peak_phase: float = quantity(0.53, "", 0.0, 1.0)
    """Share of the gait cycle after touchdown at which the torque is greatest; the shape is that of the profiles of
    Zhang et al. (2017), Science 356:1280-1284, from memory."""

    rise: float = quantity(0.25, "", 0.02, 0.5)
    """Share of the gait cycle in which the torque rises to its peak."""

    fall: float = quantity(0.10, "", 0.02, 0.5)
    """Share of the gait cycle in which it falls."""

    mass: float = quantity(0.8, "kg", 0.05, 10.0)
    """Mass on each shank."""

    side: Sides = "Both"
    """Side of the body."""

    known: bool = True
    """Whether the walker's model includes mass and torque."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        for leg in limbs_of(self.side, LEGS):
            skeleton = _with_frame(skeleton, leg.side, leg.shank, leg.ankle, 0.053, self.mass)
        return skeleton

    def assistance(self) -> Iterator[Assistance]:
        joints = {leg.side: leg.ankle for leg in limbs_of(self.side, LEGS)}
        return _assistance(joints, -self.peak_torque, self)


@dataclass(frozen=True)
class HipExoskeleton:
    """Assists flexion of the hip around toe-off."""

    peak_torque: float = quantity(10.0, "N m", -100.0, 100.0)
    """Greatest torque in flexion; negative values oppose it."""

    peak_phase: float = quantity(0.65, "", 0.0, 1.0)
    """Share of the gait cycle after touchdown at which the torque is greatest: early swing (our choice)."""

    rise: float = quantity(0.20, "", 0.02, 0.5)
    """Share of the gait cycle in which the torque rises to its peak."""

    fall: float = quantity(0.20, "", 0.02, 0.5)
    """Share of the gait cycle in which it falls."""

    mass: float = quantity(1.0, "kg", 0.05, 10.0)
    """Mass on each thigh."""

    side: Sides = "Both"
    """Side of the body."""

    known: bool = True
    """Whether the walker's model includes mass and torque."""

    def applied(self, skeleton: Skeleton) -> Skeleton:
        for leg in limbs_of(self.side, LEGS):
            skeleton = _with_frame(skeleton, leg.side, leg.thigh, leg.knee, 0.085, self.mass)
        return skeleton

    def assistance(self) -> Iterator[Assistance]:
        joints = {leg.side: leg.hip_flexion for leg in limbs_of(self.side, LEGS)}
        return _assistance(joints, self.peak_torque, self)


DEVICES: dict[str, type[Device]] = {
    "ankle_prosthesis": AnkleProsthesis,
    "ankle_exoskeleton": AnkleExoskeleton,
    "hip_exoskeleton": HipExoskeleton,
}
"""The devices that a scenario can name."""


def _hangs_on(skeleton: Skeleton, segment: Segment, shank: Segment) -> bool:
    """Whether joints connect a segment outward with a shank."""
    inboard = skeleton.inboard(segment.name)
    while isinstance(inboard, Joint) and inboard.parent != shank.name:
        inboard = skeleton.inboard(inboard.parent)
    return isinstance(inboard, Joint)


def _spring(stiffness: float, damping: float, rest_angle: float = 0.0) -> dict[str, Any]:
    """Fields of a joint that has a spring and a damper, and no muscles."""
    return {
        "effort_limit_N_m": NO_TORQUE,
        "stiffness": stiffness,
        "damping": damping,
        "rest_angle": rest_angle,
    }


def _assistance(
    joints: Mapping[Side, str], peak: float, device: "AnkleExoskeleton | HipExoskeleton"
) -> Iterator[Assistance]:
    """Yield the torque of an exoskeleton on one joint of each side."""
    for side, joint in joints.items():
        yield Assistance(side, joint, peak, device.peak_phase, device.rise, device.fall, device.known)


def _with_frame(skeleton: Skeleton, side: Side, body: str, end_joint: str, girth: float, mass: float) -> Skeleton:
    """Return the skeleton with a strut on the outer side of a body, and cuffs around it.

    Args:
        skeleton: Of the wearer.
        side: Side of the leg.
        body: Segment that carries the mass.
        end_joint: Joint at the lower end of the segment.
        girth: Radius of the segment of the reference human [m].
        mass: Of the frame [kg].

    Raises:
        ParameterError: The body has a frame already.
    """
    name = f"Device_{body}"
    if skeleton.inboard(name):
        raise ParameterError(f"side: {body} already has a frame; allowed: one on each segment; remove one device")
    along, across, _ = skeleton.size(body)
    length = -skeleton.joint(end_joint).origin[2]
    radius = girth * across
    y: float = OUTWARD[side] * (radius + 0.012)
    top, end = 0.42 * length, -0.5 * length
    drawn = (
        capsule(name, "strut", (0.0, y, top), (0.0, y, end), 0.010, CARBON),
        _ring(name, "upper_cuff", 0.30 * length, (radius + 0.006) * along),
        _ring(name, "lower_cuff", -0.20 * length, (0.85 * radius + 0.006) * along),
        ball(name, "motor", (0.0, y, end), 0.028, METAL),
    )
    frame = Segment(name, Cylinder(radius, length), mass, (0.0, 0.0, 0.0), "exoskeleton", drawn=drawn)
    return replace(
        skeleton,
        segments=(*skeleton.segments, frame),
        welds=(*skeleton.welds, Weld(body, name, (0.0, 0.0, -0.5 * length))),
    )


def _ring(body: str, part: str, z: float, radius: float) -> Visual:
    center: Vector3 = (0.0, 0.0, z)
    return Visual(body, part, "cylinder", (radius, 0.05), center, (0.0, 0.0, 0.0), CUFF)
