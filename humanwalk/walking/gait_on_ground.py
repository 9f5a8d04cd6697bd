"""The thesis' walk on ground that is not level: its footholds, its foot paths and its pelvis are placed on the ground.

The walk itself is that on level ground (`gait.walking_gait`), in time and in the order of its steps. What is added to
it here is 0 on level ground:

- a foothold moves to the nearest place where the sole lies on one face, and the sole has the slopes of the face;
- between two footholds the path of the foot is tilted: its ground is the plane that turns from the one to the other;
- what stands out of that plane under the sole is cleared by an additional lift (`swing_clearance`);
- on stairs the heel rises before lift-off, until the sole is parallel to the line to the other foothold: down stairs no
  ankle bends far enough for a flat one, and up stairs the leg behind becomes long enough;
- the pelvis follows the thesis' spline through the heights of the footholds, lowered where a leg would be too short.
"""

import cmath
import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from humanwalk.body.contact import SoleExtent, sole_extent
from humanwalk.body.skeleton import Skeleton
from humanwalk.gait.foot_cycle import FootPathParameters, SwingCurve, swing_hump
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.splines import CubicHermite
from humanwalk.gait.walking_gait import FootTarget, GaitTarget, PelvisTarget, WalkingGait
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip, quintic_blend
from humanwalk.quantity import ParameterError
from humanwalk.sides import SIDES, Side, other_side
from humanwalk.terrain.face import Face
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.footholds import Foothold, FootholdSearch, nearest_foothold, places_on
from humanwalk.walking.motions import PlanarMotion, ScalarMotion
from humanwalk.walking.swing_clearance import TIMES, Clearance, ClearanceParameters, OrdinarySwing, clearance

HEEL_FALL = 0.5
"""Part of the swing in which the heel that rose before it sinks again."""

LONGEST_SHIFT = 0.5
"""Longest way of a foothold along the walk from its place on level ground, as a part of a step."""

STANCE_SAMPLES = np.linspace(-1.0, 1.0, 9)
"""Places of the pelvis in a stance, from its beginning to its end, at which the reach of the leg is checked."""

ROUNDING = 1e-6
"""Height by which the legs may be too short before the pelvis is lowered [m]."""


class PlacedSwing(NamedTuple):
    """A stance on a foothold and the swing to the next one.

    Attributes:
        curve: Path of the swing on level ground.
        start, goal: Footholds.
        places: Their places on level ground, x + iy [m].
        added: Additional height and delays that clear the ground.
        heel_rise: Pitch of the sole at lift-off [rad].
        front: Distance of the toe end ahead of the ankle [m].
    """

    curve: SwingCurve
    start: Foothold
    goal: Foothold
    places: tuple[complex, complex]
    added: Clearance
    heel_rise: float
    front: float

    def placed(self, foot: FootTarget, heel: ScalarMotion) -> FootTarget:
        """Return the motion of a foot on level ground, placed on the ground.

        Args:
            foot: The motion on level ground.
            heel: Pitch of the sole as a share of that at lift-off.
        """
        share, moved = (self._way(foot, *interval) for interval in ((0.0, 1.0), (self.added.depart, self.added.arrive)))
        shift, ground = self._shift(share, moved), self._ground_below(share, moved)
        lift = self.added.at(foot.progress).time_scaled(foot.progress_rate)
        (pitch_0, roll_0), (pitch_1, roll_1) = sole_angles(self.start.face), sole_angles(self.goal.face)
        pitch, roll = turned(pitch_0, pitch_1, moved), turned(roll_0, roll_1, moved)
        rise = turned(0.0, self.heel_rise, heel)
        pivot = self._pivot(pitch, pitch.plus(rise))
        (x, y, z), (v_x, v_y, v_z) = foot.position, foot.velocity
        (dx, dy), (dv_x, dv_y) = ((at.real, at.imag) for at in shift[:2])
        up = ground.plus(lift)
        return foot._replace(
            position=(x + dx + pivot.position.real, y + dy, z + up.value + pivot.position.imag),
            velocity=(v_x + dv_x + pivot.velocity.real, v_y + dv_y, v_z + up.rate + pivot.velocity.imag),
            height=foot.height + lift.value + pivot.position.imag,
            height_rate=foot.height_rate + lift.rate + pivot.velocity.imag,
            pitch=foot.pitch + pitch.value + rise.value,
            pitch_rate=foot.pitch_rate + pitch.rate + rise.rate,
            roll=roll.value,
            roll_rate=roll.rate,
        )

    def _way(self, foot: FootTarget, begin: float, end: float) -> ScalarMotion:
        """Share of the step that a foot has made which moves between two progresses of its swing."""
        progress = clip((foot.progress - begin) / (end - begin), 0.0, 1.0)
        share, slope = self.curve.way(np.array(progress))
        return ScalarMotion(float(share), float(slope) * foot.progress_rate / (end - begin))

    def _shift(self, share: ScalarMotion, moved: ScalarMotion) -> PlanarMotion:
        """Displacement over the plane from the path on level ground: the foot moves later, and to other footholds."""
        (begin, end), length = (self.start.position, self.goal.position), self.places[1] - self.places[0]
        first, last = begin - self.places[0], end - self.places[1]
        return PlanarMotion(
            (moved.value - share.value) * length + first + moved.value * (last - first),
            (moved.rate - share.rate) * length + moved.rate * (last - first),
        )

    def _ground_below(self, share: ScalarMotion, moved: ScalarMotion) -> ScalarMotion:
        """Height of the plane that turns from the old to the new foothold, below the ankle."""
        old, new, way = self.start.face, self.goal.face, self.goal.position - self.start.position
        at, velocity = self.start.position + moved.value * way, moved.rate * way
        xy = np.array((at.real, at.imag))
        low, high = float(old.height(xy)), float(new.height(xy))
        along, across = (a + share.value * (b - a) for a, b in zip(old.gradient, new.gradient, strict=True))
        rate = share.rate * (high - low) + along * velocity.real + across * velocity.imag
        return ScalarMotion(low + share.value * (high - low), rate)

    def _pivot(self, flat: ScalarMotion, pitch: ScalarMotion) -> PlanarMotion:
        """Displacement x + iz of the point of the sole below the ankle, while the sole turns about its toe end."""
        before, after = (self.front * cmath.exp(-1j * angle.value) for angle in (flat, pitch))
        return PlanarMotion(before - after, 1j * (pitch.rate * after - flat.rate * before))


def turned(start: float, end: float, share: ScalarMotion) -> ScalarMotion:
    """Return an angle on its way from `start` to `end`, and its rate."""
    return ScalarMotion(start + share.value * (end - start), share.rate * (end - start))


def heel_motion(foot: FootTarget, duty_factor: float, phase_rate: float) -> ScalarMotion:
    """Return the pitch of a sole as a share of that at lift-off: it grows from mid-stance on, and falls in swing.

    Args:
        foot: The motion on level ground.
        duty_factor: Part of the cycle in stance.
        phase_rate: Cycles per second.
    """
    middle = 0.5 * duty_factor
    grown = quintic_blend(clip(foot.phase / middle - 1.0, 0.0, 1.0))
    fallen = quintic_blend(clip(foot.progress / HEEL_FALL, 0.0, 1.0))
    return ScalarMotion(
        grown[0] - fallen[0], grown[1] * phase_rate / middle - fallen[1] * foot.progress_rate / HEEL_FALL
    )


def sole_angles(face: Face) -> tuple[float, float]:
    """Return pitch and roll [rad] of a sole that stands on a face, see `FootTarget`."""
    along, across = face.gradient
    return -math.atan(along), math.atan2(across, math.hypot(1.0, along))


def lowest_point(curve: SwingCurve, toe_drop: float, sole: SoleExtent) -> Array:
    """Return the height [m] of the toes above the ground at `TIMES` of a swing on level ground, shape (SAMPLES,)."""
    heights = np.array([curve.position(float(progress))[1] for progress in TIMES])
    lowest: Array = heights - sole.front * np.sin(toe_drop * swing_hump(TIMES)[0])
    return lowest


class GaitOnGround(WalkingGait):
    """Foot and pelvis targets of a walk along +x over a ground, see `WalkingGait`.

    Footholds, swings and heights are functions of their numbers; each is calculated when it is used first, and kept.
    """

    def __init__(
        self,
        parameters: FootPathParameters,
        ramp: SpeedRamp,
        first_swing: Side,
        ground: Ground,
        skeleton: Skeleton,
        search: FootholdSearch | None = None,
        law: ClearanceParameters | None = None,
    ) -> None:
        """Make the walk.

        Args:
            parameters: Foot path on level ground.
            ramp: Speed over time.
            first_swing: Side of the foot that swings first.
            ground: The ground.
            skeleton: Whose legs and soles.
            search: Which faces are footholds.
            law: How a swing clears the ground.
        """
        super().__init__(parameters, skeleton.hip_half_width, ramp, first_swing)
        self._ground, self._sole = ground, sole_extent(skeleton)
        self._search, self._law = search or FootholdSearch(), law or ClearanceParameters()
        self._ankle_height = skeleton.hip_height - skeleton.leg_length
        self._hip_height = skeleton.hip_height - parameters.offset
        self._footholds: list[Mapping[Side, Foothold]] = [
            {side: Foothold.on(ground, self._place(side, 0)) for side in SIDES}
        ]
        self._swings: dict[tuple[Side, int], PlacedSwing] = {}
        self._splines: dict[int, CubicHermite] = {}

    def footholds(self, step: int) -> Mapping[Side, Foothold]:
        """Return the footholds of both feet after a number of steps.

        Raises:
            ParameterError: there is no foothold for one of these steps.
        """
        for k in range(len(self._footholds), step + 1):
            feet, side = self._footholds[-1], self._stepping(k)
            goal = self._next_foothold(side, k, feet[other_side(side)].ground)
            self._footholds.append({**feet, side: goal})
        return self._footholds[step]

    def pelvis(self, t: float) -> PelvisTarget:
        """See `WalkingGait.pelvis`; here it follows the ground."""
        level = super().pelvis(t)
        rise, slope, curvature = self.rise(level.distance)
        return level._replace(
            drop=level.drop - rise,
            drop_rate=level.drop_rate - slope * level.speed,
            drop_acceleration=level.drop_acceleration - (curvature * level.speed**2 + slope * level.acceleration),
        )

    def target(self, t: float) -> GaitTarget:
        """See `WalkingGait.target`; the heights of swinging feet are above the plane between their footholds."""
        target, p = super().target(t), self.parameters
        phase_rate = target.pelvis.speed / p.walked_stride
        right, left = (
            self._swing(side, foot.step).placed(foot, heel_motion(foot, p.duty_factor, phase_rate))
            for side, foot in zip(SIDES, target[2:], strict=True)
        )
        return target._replace(right=right, left=left)

    def rise(self, distance: float) -> ScalarMotion:
        """Return the height of the pelvis above that on level ground [m], and its derivatives by the distance."""
        step = self.parameters.walked_step
        before = int(distance / step)
        if before not in self._splines:
            # The tangents at the inner two of four points are those of the whole spline.
            heights = [self._line(max(k, 0)) - self._lowering(max(k, 0)) for k in range(before - 1, before + 3)]
            self._splines[before] = CubicHermite(np.array(heights)[:, None])
        u = 1.0 + distance / step - before
        values = (float(self._splines[before].derivative(u, order)[0]) / step**order for order in range(3))
        return ScalarMotion(*values)

    def _next_foothold(self, side: Side, k: int, level: float) -> Foothold:
        place, sole, p = self._place(side, k), self._sole, self.parameters

        def is_reachable(at: complex, height: float) -> bool:
            return (
                abs(at.real - place.real) <= LONGEST_SHIFT * p.walked_step
                and at.imag * math.copysign(1.0, place.imag) >= min(sole.half_width, abs(place.imag))
                and abs(height - level) <= self._search.max_rise
            )

        found = nearest_foothold(self._ground, place, 0.0, sole, self._search, is_reachable, level=level)
        on_face = places_on(found.face, found.position, 0.0, sole, self._search)
        if found.position not in on_face or not is_reachable(found.position, found.ground):
            raise ParameterError(
                f"controller.thesis.gait.path.step_length: {p.step_length:g} has no foothold for step {k}, at "
                f"x = {place.real:.2f} m; allowed: steps that end on one face of the ground, up or down by "
                f"{self._search.max_rise:g} m at most; on stairs or stones set it to {2.0 * p.duty_factor:g} times the "
                "length of a tread, or choose another terrain"
            )
        return found

    def _place(self, side: Side, k: int) -> complex:
        """Place of foothold k on level ground."""
        return complex(k * self.parameters.walked_step, self._y(side))

    def _stepping(self, k: int) -> Side:
        """Side of the foot that lands at foothold k."""
        return self.first_swing if k % 2 else other_side(self.first_swing)

    def _swing(self, side: Side, step: tuple[int, int]) -> PlacedSwing:
        if (side, step[0]) not in self._swings:
            start, goal = (self.footholds(k)[side] for k in step)
            places = (self._place(side, step[0]), self._place(side, step[1]))
            curve = self.swing_curve(step)
            lowest = lowest_point(curve, self.parameters.toe_drop, self._sole)
            ordinary = OrdinarySwing(lowest, lambda tau: curve.way(tau)[0])
            added = clearance(self._ground, start, goal, 0.0, self._sole, self._law, ordinary)
            heel_rise = self._heel_rise(side, step[0])
            self._swings[side, step[0]] = PlacedSwing(curve, start, goal, places, added, heel_rise, self._sole.front)
        return self._swings[side, step[0]]

    def _heel_rise(self, side: Side, k: int) -> float:
        """Pitch [rad] of the sole at lift-off from foothold k.

        It is that of the line to the other foot, which is ahead, and more if the foothold is behind its place.
        """
        start, ahead = self.footholds(k)[side], self.footholds(k + 1)[other_side(side)]
        length = abs(ahead.position.real - start.position.real)
        behind = max((self._place(side, k) - start.position).real, 0.0)
        front = self._sole.front
        return math.atan2(abs(start.step_to(ahead)), max(length, front)) + math.atan2(behind, front)

    def _line(self, k: int) -> float:
        """Height [m] of the ground of foothold k, in the plane of its face, below the middle of the body."""
        face = self.footholds(k)[self._stepping(k)].face
        return float(face.height(np.array((k * self.parameters.walked_step, 0.0))))

    def _lowering(self, k: int) -> float:
        """Distance [m] by which the pelvis is below the line of the footholds above foothold k.

        With it, no leg that stands nearby extends more than on level ground.
        """
        return max(self._shortage(stance, k) for stance in range(max(k - 1, 0), k + 2))

    def _shortage(self, stance: int, k: int) -> float:
        """Height [m] by which the leg on a foothold is too short for the line, less than a step from foothold k."""
        p, side, height = self.parameters, self._stepping(stance), self._ankle_height
        foothold = self.footholds(stance)[side]
        samples = STANCE_SAMPLES[np.abs(stance + p.duty_factor * STANCE_SAMPLES - k) <= 1.0]
        steps = stance + p.duty_factor * samples
        line = np.interp(steps, (k - 1, k, k + 1), [self._line(max(i, 0)) for i in (k - 1, k, k + 1)])
        # The ankle, as x + iz, while the sole turns about its toe end.
        pitch, front = sole_angles(foothold.face)[0], self._sole.front
        pitches = pitch + self._heel_rise(side, stance) * quintic_blend(np.clip(samples, 0.0, 1.0))[0]
        toe = complex(foothold.position.real, foothold.ground) + front * cmath.exp(-1j * pitch)
        ankle = toe + complex(-front, height) * np.exp(-1j * pitches)
        aside = foothold.position.imag + height * foothold.R_WS[1, 2] - self._y(side)
        reach = math.hypot(0.5 * p.step_length, self._hip_height - height)
        squares = reach**2 - (ankle.real - steps * p.walked_step) ** 2 - aside**2
        highest = ankle.imag + np.sqrt(np.maximum(squares, 0.0)) - self._hip_height
        return float(np.maximum(line - highest - ROUNDING, 0.0).max())
