"""The next footholds on the ground ahead, and what they change in the desired periodic gait.

The periodic gait has equal steps on a plane. The DCM at the end of a step is w times the integral of exp(-w t) z(t)
over the future zero-moment point z. With q_k the displacement of the k-th foothold from the one before, beyond that of
the gait, T_k the duration of the step that begins on it, and kappa_k that step's `foothold_gain`, irregular footholds
therefore shift it by

    sum over k of exp(-w (T_1 + ... + T_(k-1))) q_k / kappa_k.

The heights of the footholds are a third coordinate of the same equation (Englsberger et al. 2015).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, repeat
from typing import NamedTuple

from humanwalk.body.contact import SoleExtent
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity
from humanwalk.sides import OUTWARD, Side, other_side
from humanwalk.terrain.face import Face
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.command import Command
from humanwalk.walking.foot_placement import StepPlacement, foothold_gain
from humanwalk.walking.footholds import Foothold, FootholdSearch, nearest_foothold
from humanwalk.walking.lipm import PeriodicGait

STEPS = 3
"""Number of footholds that are planned; each counts a tenth to a fifth of the one before."""

PACE_RANGE = (0.2, 1.5)
"""Range of the speed over irregular footholds, relative to the desired one (our choice)."""


@dataclass(frozen=True)
class Pacing:
    """Duration and length of steps on ground that is not level."""

    free_rise: float = quantity(0.07, "m", 0.0, 0.5)
    """Difference in height between a foot's last and next foothold up to which a step has the ordinary duration."""

    slowing: float = quantity(1.8, "1/m", 0.0, 10.0)
    """Increase of the duration per difference in height beyond that, relative to the ordinary one."""

    lifting: float = quantity(3.0, "1/m", 0.0, 10.0)
    """Increase of the duration per additional lift of the foot, relative to the ordinary one."""

    friction_use: float = quantity(0.8, "", 0.1, 1.0)
    """Share of the friction that forces of the ground use at most; shortens steps on ice and on slopes."""

    free_lead: float = quantity(0.35, "", 0.0, 1.0)
    """Distance of a foothold ahead of its place in the gait, relative to the length of a step, for which the step after
    it is not shorter: on boxes of 40 cm every step of 32 cm goes to the next box."""

    min_length: float = quantity(0.05, "m", 0.0, 0.5)
    """Mean length of the desired steps from which on the speed follows the footholds."""

    def duration_factor(self, rise: float, lift: float) -> float:
        """Duration of a step relative to the ordinary one.

        Args:
            rise: Height by which the foot rises or descends [m].
            lift: Additional height to which it is lifted on its way [m].
        """
        return 1.0 + max(self.slowing * (abs(rise) - self.free_rise), self.lifting * lift, 0.0)

    def longest_step(self, face: Face, com_height: float, width: float) -> float:
        """Longest step [m] of a width [m], for which forces from feet to center of mass are within friction."""
        usable = max(self.friction_use * face.friction - math.hypot(*face.gradient), 0.0)
        return math.sqrt(max((2.0 * com_height * usable) ** 2 - width**2, self.min_length**2))


class Preview(NamedTuple):
    """The next footholds.

    Attributes:
        footholds: The next foothold, and those after it; none in standing.
        is_regular: Whether they are those of the gait, as on a plane.
        pace: Speed over the footholds, relative to that of the gait; 1 on a plane.
        ahead: Distance by which the step after the next foothold is shorter, because that is ahead of its place [m].
        durations: Those of the steps after this one, relative to this one; 1 on a plane.
        raised: Heights by which the foot behind and the stance foot rise in their next swings, to the foothold and over
            what they clear [m]; 0 on a plane.
        command: The command for which irregular footholds were planned, without forward speed in a pause after a
            disturbance; None on a plane, where the command may change.
    """

    footholds: tuple[Foothold, ...] = ()
    is_regular: bool = True
    pace: float = 1.0
    ahead: float = 0.0
    durations: tuple[float, ...] = (1.0,) * (STEPS - 1)
    raised: tuple[float, float] = (0.0, 0.0)
    command: Command | None = None

    @property
    def holds_command(self) -> bool:
        """Whether one command holds until touchdown: that for which the footholds were planned."""
        return self.command is not None

    def paced(self, command: Command) -> Command:
        """The command of the step at the pace of the footholds: the held command, or else the current one."""
        return (self.command or command).at_pace(self.pace)

    def moves(
        self, gaits: Sequence[PeriodicGait], stance: complex, side: Side, direction: complex
    ) -> tuple[complex, ...]:
        """Displacements from each foothold to the next, beyond those of the gaits of the steps [m]; 0 on a plane.

        Args:
            gaits: Of this step and of the next ones.
            stance: The stance foot [m].
            side: Its side.
            direction: Its heading, as a unit vector.
        """
        if not self.holds_command:
            return (0.0,) * len(self.footholds)
        moves = []
        for foothold, gait in zip(self.footholds, gaits, strict=True):
            moves.append(foothold.position - stance - gait.displacement.on(side) * direction)
            direction, stance, side = direction * cmath.exp(1j * gait.turn), foothold.position, other_side(side)
        return tuple(moves)

    def shifted(self, displacement: complex) -> Preview:
        """The preview with displaced footholds [m]; without a held command they follow from the gait.

        The DCM keeps its place relative to a stance foot that has not touched the ground yet.
        """
        if not self.holds_command:
            return self
        moved = (foothold._replace(position=foothold.position + displacement) for foothold in self.footholds)
        return self._replace(footholds=tuple(moved))


def dcm_shift(increments: Sequence[complex], following: Sequence[PeriodicGait], frequency: float) -> complex:
    """Displacement of the DCM at the end of the step by increments of the future footholds [m]; complex or heights.

    Args:
        increments: Of each foothold relative to the one before.
        following: The gaits of the steps that begin on them, the last one of all steps after them.
        frequency: Natural frequency of the pendulum [1/s].
    """
    total, decay = 0.0 + 0.0j, 1.0
    for increment, gait in zip(increments, chain(following, repeat(following[-1])), strict=False):
        total += decay * increment / foothold_gain(frequency, gait.double_support)
        decay *= math.exp(-frequency * gait.step)
    return total


@dataclass(frozen=True)
class FootholdPlanner:
    """Plans footholds on the ground.

    Attributes:
        sole: Extent of a sole.
        search: Which faces are footholds.
        placement: Limits of the footholds.
        pacing: Length of steps.
        com_height: Height of the center of mass above the ground [m].
    """

    sole: SoleExtent
    search: FootholdSearch
    placement: StepPlacement
    pacing: Pacing
    com_height: float

    def nearest(
        self,
        ground: Ground,
        desired: complex,
        yaw: float,
        stance: Foothold,
        side: Side,
        direction: complex,
        current: Face | None = None,
        expected: complex | None = None,
        is_final: bool = False,
    ) -> Foothold:
        """The nearest foothold that the other foot reaches from a stance foot; see `nearest_foothold`.

        Args:
            ground: What is known of the ground.
            desired: Desired position of the ankle [m].
            yaw: Heading of the foot [rad].
            stance: The stance foot.
            side: Its side.
            direction: Its heading, as a unit vector.
            current: Face that the foot is on its way to.
            expected: Desired position when the foot lands [m].
            is_final: Whether the face does not change any more.
        """
        desired_width = OUTWARD[other_side(side)] * ((desired - stance.position) / direction).imag

        def is_reachable(place: complex, height: float) -> bool:
            local = (place - stance.position) / direction
            # Balance may desire a step that is narrower than the legs like.
            min_width = min(self.placement.min_step_width(local.real), desired_width)
            return (
                abs(height - stance.ground) <= self.search.max_rise
                and abs(local.real) <= self.placement.max_length
                and OUTWARD[other_side(side)] * local.imag >= min_width - 1e-9
            )

        return nearest_foothold(
            ground, desired, yaw, self.sole, self.search, is_reachable, current, expected, is_final, stance.ground
        )

    def preview(
        self,
        ground: Ground,
        stance: Foothold,
        side: Side,
        heading: float,
        gait: PeriodicGait,
        ahead: float = 0.0,
        current: Face | None = None,
    ) -> Preview:
        """The next footholds of a gait.

        Args:
            ground: What is known of the ground.
            stance: The stance foot.
            side: Its side.
            heading: Its heading [rad].
            gait: The desired gait.
            ahead: Distance of the stance foot ahead of its place in the gait [m], in the direction of travel.
            current: Face of the next foothold in the plan before; it is preferred, because the DCM goes there.
        """
        footholds, is_regular = [], True
        sense = -1.0 if gait.displacement.right.real + gait.displacement.left.real < 0.0 else 1.0
        length = desired_length = first_ahead = 0.0
        for face in (current, *(None,) * (STEPS - 1)):
            direction = cmath.exp(1j * heading)
            step = gait.displacement.on(side)
            longest = self.pacing.longest_step(stance.face, self.com_height, abs(step.imag))
            shortened = complex(clip(step.real - sense * ahead, -longest, longest), step.imag)
            desired = stance.position + shortened * direction
            heading += gait.turn
            foothold = self.nearest(ground, desired, heading, stance, side, direction, face)
            is_regular &= foothold.position == desired and shortened == step
            footholds.append(foothold)
            length += sense * ((foothold.position - desired) / direction + shortened).real
            desired_length += sense * step.real
            lead = sense * ((foothold.position - desired) / direction).real
            ahead = max(lead - self.pacing.free_lead * abs(step.real), 0.0)
            first_ahead = ahead if len(footholds) == 1 else first_ahead
            stance, side = foothold, other_side(side)
        pace = 1.0
        if desired_length > STEPS * self.pacing.min_length:
            pace = clip(length / desired_length, *PACE_RANGE)
        return Preview(tuple(footholds), is_regular, pace, first_ahead)
