"""When and where to step, and what the body should do meanwhile, so that the walker stays on its feet.

A clock goes through double and single support. The divergent component of motion (DCM) that is measured is compared
with that of the periodic walk which is wanted: what the ankle can mend moves the zero-moment point under the foot,
what it cannot mend moves the next foothold, and what no foothold within reach can mend hastens the step.

Points of the ground plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import NamedTuple

from humanwalk.body import SIDES, Side
from humanwalk.numerics.scalars import clip, quintic_blend, wrapped
from humanwalk.quantity import quantity
from humanwalk.terrain.terrain import Terrain, height_at
from humanwalk.walking.base_of_support import BaseOfSupport
from humanwalk.walking.com_height import ComHeight
from humanwalk.walking.command import Command
from humanwalk.walking.commanded_path import CommandedPath, PathFollowing
from humanwalk.walking.counter_rotation import CounterRotation
from humanwalk.walking.foot_placement import StepPlacement, foothold_gain
from humanwalk.walking.foot_rockers import FootRockers
from humanwalk.walking.lipm import (
    HalfSteps,
    PeriodicGait,
    ZmpSegment,
    backward,
    carried,
    divergent_component,
    forward,
    natural_frequency,
)
from humanwalk.walking.swing_foot import PlanarMotion, SwingParameters, SwingProfile
from humanwalk.walking.walking_reference import BodyState, FootReference, FootTask, Phase, WalkingReference, other

SHORT_STEP = 1.2
"""A step is short if this many times its length is less than the way of the command meanwhile: the ordinary one, which
ends early, is not."""

TOES_RELAXED = 0.4
"""Share of the swing after which toes that were bent over the ground are straight again."""


@dataclass(frozen=True)
class StepTiming:
    """Durations of a step."""

    step: float = quantity(0.53, "s", 0.3, 1.2)
    """From touchdown to touchdown of the other foot."""

    double_support: float = quantity(0.10, "s", 0.04, 0.4)
    """Both feet carry: the beginning of the step."""

    weight_shift: float = quantity(1.0, "s", 0.3, 3.0)
    """From quiet standing onto the first stance foot."""

    early_touchdown: float = quantity(0.85, "", 0.3, 1.0)
    """Share of the single support after which a touch of the ground ends it."""

    touchdown_force: float = quantity(60.0, "N", 5.0, 500.0)
    """Vertical force that counts as a touch."""

    hurry: float = quantity(15.0, "1/m", 0.0, 100.0)
    """Extra rate of the clock per metre by which the foothold that balance wants is out of reach."""

    hurry_limit: float = quantity(0.8, "", 0.0, 3.0)
    """Greatest extra rate of the clock."""

    lift_off_limit: float = quantity(3.0, "", 0.0, 10.0)
    """The same in double support when balance wants the next foothold across the stance foot."""


@dataclass(frozen=True)
class StepPlannerParameters:
    """How the walker steps and balances."""

    timing: StepTiming = StepTiming()
    placement: StepPlacement = StepPlacement()
    support: BaseOfSupport = BaseOfSupport()
    rockers: FootRockers = FootRockers()
    swing: SwingParameters = SwingParameters()
    height: ComHeight = ComHeight()
    path: PathFollowing = PathFollowing()
    rotation: CounterRotation = CounterRotation()

    dcm_gain: float = quantity(1.0, "", 0.0, 5.0)
    """The error of the DCM shrinks at this many times the pendulum's own rate, while the foot is long enough."""

    double_support_gain: float = quantity(2.0, "", 0.0, 20.0)
    """The same in double support, where both feet together are long enough for more."""

    stop_speed: float = quantity(0.05, "m/s", 0.0, 0.3)
    """A step that is commanded slower than this is the last."""


class Swing(NamedTuple):
    """The swinging foot.

    motion: of the ankle over the level plane.
    profile: of height and pitch, for a foothold as high as the ground that the foot left.
    foothold: where the ankle goes [m].
    rise: height of the ground at the foothold above that at lift-off [m].
    start_yaw, start_toes: yaw of the foot and extension of its toes at lift-off [rad].
    """

    motion: PlanarMotion
    profile: SwingProfile
    foothold: complex
    rise: float
    start_yaw: float
    start_toes: float


class PlannerState(NamedTuple):
    """What the planner remembers from tick to tick.

    phase; elapsed: in the phase for standing and shift, in the step for double and single support [s].
    stance: the foot that carries in this step.
    right, left: ankles as they stand [m]; the swinging foot's is where it stood.
    right_ground, left_ground: height of the ground below them [m].
    support_start: height of the ground under the support as the phase began [m].
    heading, old_heading: of this step and of the one before [rad].
    path: what was commanded.
    turn: of the path where the walker is [rad/s].
    to_path: speed in this step beyond the commanded one, towards the path [m/s].
    height, height_rate: of the center of mass above the ground under the support, without its arcs [m, m/s].
    walked: steps since standing.
    swing: of the foot in the air.
    """

    phase: Phase
    elapsed: float
    stance: Side
    right: complex
    left: complex
    right_ground: float
    left_ground: float
    support_start: float
    heading: float
    old_heading: float
    path: CommandedPath
    height: float
    height_rate: float = 0.0
    turn: float = 0.0
    to_path: complex = 0.0
    walked: int = 0
    swing: Swing | None = None

    def __deepcopy__(self, memo: object) -> PlannerState:
        """Return itself: Drake copies abstract values often, and the state is immutable."""
        return self

    def ankle(self, side: Side) -> complex:
        """Where a foot stands."""
        return self.right if side == "Right" else self.left

    def ground(self, side: Side) -> float:
        """Height of the ground where a foot stands."""
        return self.right_ground if side == "Right" else self.left_ground

    @property
    def middle(self) -> complex:
        """Between the ankles."""
        return 0.5 * (self.right + self.left)


class StepPlanner:
    """The planner's law: a pure function from its state, the body and the command to the next state and a reference.

    Args:
        parameters: see there.
        standing_com_height: height of the centre of mass in straight standing [m].
        ankle_height: height of the ankle of a flat foot [m].
        leg_length: distance of hip and ankle of a straight leg [m].
        first_swing: the foot that swings first.
        period: time between two ticks [s].
        terrain: on which the walker steps.
    """

    def __init__(
        self,
        parameters: StepPlannerParameters,
        standing_com_height: float,
        ankle_height: float,
        leg_length: float,
        first_swing: Side,
        period: float,
        terrain: Terrain,
    ) -> None:
        self.parameters = parameters
        self.standing_com_height = standing_com_height
        self.frequency = natural_frequency(parameters.height.walking * standing_com_height)
        self.ankle_height = ankle_height
        self.leg_length = leg_length
        self.first_swing = first_swing
        self.period = period
        self.terrain = terrain

    def start(self, body: BodyState, heading: float = 0.0) -> PlannerState:
        """Standing on both feet; the path begins along a heading, wherever the feet face."""
        middle = 0.5 * (body.right.position + body.left.position)
        right_ground, left_ground = (height_at(self.terrain, foot.position) for foot in (body.right, body.left))
        support = 0.5 * (right_ground + left_ground)
        return PlannerState(
            phase=Phase.STAND,
            elapsed=0.0,
            stance=other(self.first_swing),
            right=body.right.position,
            left=body.left.position,
            right_ground=right_ground,
            left_ground=left_ground,
            support_start=support,
            heading=heading,
            old_heading=heading,
            path=CommandedPath.begin(middle, heading),
            height=body.com_height - support,
        )

    def update(self, state: PlannerState, body: BodyState, command: Command) -> tuple[PlannerState, WalkingReference]:
        """One tick: the next state, and what the body should do until then."""
        xi = divergent_component(body.com, body.com_velocity, self.frequency)
        state = self._transition(state, body, command)
        if state.phase in (Phase.STAND, Phase.WEIGHT_SHIFT):
            return self._stand(state, body, command, xi)
        return self._step(self._settled(state, body), body, command, xi)

    # Phases.

    def _transition(self, state: PlannerState, body: BodyState, command: Command) -> PlannerState:
        timing = self.parameters.timing
        moving = abs(command.velocity) > self.parameters.stop_speed or abs(command.turn) > self.parameters.stop_speed
        if state.phase is Phase.STAND and moving:
            return state._replace(phase=Phase.WEIGHT_SHIFT, elapsed=0.0, support_start=self._support(state)[0])
        if state.phase is Phase.WEIGHT_SHIFT and state.elapsed >= timing.weight_shift:
            # The shift is the first step's double support: the foot that was left carries nothing any more.
            return self._lift_off(state._replace(elapsed=timing.double_support), body, command)
        if state.phase is Phase.DOUBLE_SUPPORT and state.elapsed >= timing.double_support:
            return self._lift_off(state, body, command)
        if state.phase is Phase.SINGLE_SUPPORT and self._has_landed(state, body):
            return self._touch_down(state, body, command, moving)
        return state

    def _has_landed(self, state: PlannerState, body: BodyState) -> bool:
        progress, timing = self._progress(state), self.parameters.timing
        touches = body.foot(other(state.stance)).force > timing.touchdown_force
        return progress >= 1.0 or (progress > timing.early_touchdown and touches)

    def _progress(self, state: PlannerState) -> float:
        """Share of the swing that is over."""
        timing = self.parameters.timing
        return (state.elapsed - timing.double_support) / (timing.step - timing.double_support)

    def _lift_off(self, state: PlannerState, body: BodyState, command: Command) -> PlannerState:
        timing = self.parameters.timing
        foot = body.foot(other(state.stance))
        profile = SwingProfile.from_lift_off(
            foot.height,
            foot.height_rate,
            foot.pitch,
            foot.pitch_rate,
            state.ground(other(state.stance)) + self.ankle_height,
            self.parameters.swing.heel_strike(command.forward),
            timing.step - timing.double_support,
            self.parameters.swing,
        )
        pace = command.velocity * cmath.exp(1j * state.heading)
        motion = PlanarMotion(foot.position, foot.velocity, self.parameters.swing.leaving(pace))
        left_as = self._other_foot(state, command, None, 1.0)
        swing = Swing(motion, profile, foot.position, 0.0, foot.yaw, left_as.toes[0])
        return state._replace(phase=Phase.SINGLE_SUPPORT, support_start=state.ground(state.stance), swing=swing)

    def _touch_down(self, state: PlannerState, body: BodyState, command: Command, moving: bool) -> PlannerState:
        """The swinging foot becomes the stance foot; both are where they are measured, so that no error adds up."""
        right, left = body.right.position, body.left.position
        middle = 0.5 * (right + left)
        following = self.parameters.path
        path = following.leashed(state.path, state.path.beside(middle, command))
        beside = path.beside(middle, command)
        stance = other(state.stance)
        ahead = path.beside(body.foot(stance).position, command)
        return PlannerState(
            phase=Phase.DOUBLE_SUPPORT if moving else Phase.STAND,
            elapsed=0.0,
            stance=stance,
            right=right,
            left=left,
            right_ground=height_at(self.terrain, right),
            left_ground=height_at(self.terrain, left),
            support_start=state.ground(state.stance),
            heading=ahead.heading,
            old_heading=state.heading,
            path=path,
            turn=ahead.turn,
            to_path=following.correction(path, beside, middle, command),
            height=state.height,
            height_rate=state.height_rate,
            walked=state.walked + 1 if moving else 0,
        )

    def _settled(self, state: PlannerState, body: BodyState) -> PlannerState:
        """A stance foot that has not come to the ground yet will stand where it is now, not where its time was over."""
        foot, timing = body.foot(state.stance), self.parameters.timing
        airborne = foot.force < timing.touchdown_force and state.walked > 0
        if not (airborne and 0.0 < state.elapsed <= self.parameters.rockers.heel):
            return state
        ground = height_at(self.terrain, foot.position)
        if state.stance == "Right":
            return state._replace(right=foot.position, right_ground=ground)
        return state._replace(left=foot.position, left_ground=ground)

    # Standing.

    def _stand(
        self, state: PlannerState, body: BodyState, command: Command, xi: complex
    ) -> tuple[PlannerState, WalkingReference]:
        """Keep the DCM in the middle, or bring it to where the first step begins."""
        u = cmath.exp(1j * state.heading)
        reference, rate = self.parameters.support.middle_of(state.middle, state.heading), 0.0 + 0.0j
        if state.phase is Phase.WEIGHT_SHIFT:
            gait = self._gait(state, command)
            stance_is_left = state.stance == "Left"
            segments = gait.segments(stance_is_left)[1:]
            ends = gait.end_offsets(self.frequency)
            goal = backward(segments, ends.left if stance_is_left else ends.right, self.frequency) * u
            goal += self.parameters.support.middle_of(state.ankle(state.stance), state.heading)
            share, slope, _ = quintic_blend(min(state.elapsed / self.parameters.timing.weight_shift, 1.0))
            rate = slope * (goal - reference) / self.parameters.timing.weight_shift
            reference += share * (goal - reference)
        zmp = reference - rate / self.frequency + (1.0 + self.parameters.dcm_gain) * (xi - reference)
        zmp = self._supported(state, zmp, both=True)
        feet: dict[Side, FootReference] = {side: FootReference(FootTask.FLAT, 1.0, state.heading) for side in SIDES}
        path = state.path.advanced(command, self.period)
        next_state = state._replace(elapsed=state.elapsed + self.period, path=path)
        next_state, height = self._height(next_state, 0.0)
        return next_state, self._reference(state, body, zmp, xi, reference, height, feet, state.middle)

    # Stepping.

    def _step(
        self, state: PlannerState, body: BodyState, command: Command, xi: complex
    ) -> tuple[PlannerState, WalkingReference]:
        timing = self.parameters.timing
        stance_is_left = state.stance == "Left"
        u = cmath.exp(1j * state.heading)
        gait = self._gait(state, command)
        displacement = gait.displacement.left if stance_is_left else gait.displacement.right
        ends = gait.end_offsets(self.frequency)
        stance_point = self.parameters.support.middle_of(state.ankle(state.stance), state.heading)
        end = stance_point + u * (ends.left if stance_is_left else ends.right)

        segments = self._segments_left(state, gait)
        zmp_reference = segments[0].start
        xi_reference = backward(segments, end, self.frequency)
        both = state.phase is Phase.DOUBLE_SUPPORT
        gain = self.parameters.double_support_gain if both else self.parameters.dcm_gain
        zmp = self._supported(
            state,
            zmp_reference + (1.0 + gain) * (xi - xi_reference),
            both=both,
            on_ball=state.swing is not None and self._heel_is_up(state, command, state.swing),
        )

        rate, swing = 1.0, state.swing
        error = (forward(segments, xi, self.frequency) - end) / u
        wanted = displacement + foothold_gain(self.frequency, timing.double_support) * error
        place = (body.foot(other(state.stance)).position - state.ankle(state.stance)) / u
        if both:
            across = self.parameters.placement.late_lift_off(wanted, state.stance, place)
            rate += min(timing.hurry * across, timing.lift_off_limit)
        foothold_W, highest = state.ankle(other(state.stance)), math.inf
        if swing is not None:
            placement, stance = self.parameters.placement, state.ankle(state.stance)
            foothold, beyond = placement.within_reach(wanted, state.stance, place)
            rate += min(timing.hurry * beyond, timing.hurry_limit)
            com = carried(body.com, xi, zmp, (timing.step - state.elapsed) / rate, self.frequency)
            foothold = placement.near_body(foothold, (com - stance) / u)
            swing = self._swing_on(state, swing, stance + u * foothold, rate, command)
            foothold_W, reach = swing.foothold, (swing.foothold - com) / u
            highest = self.parameters.height.highest_for(reach, self.leg_length, self.standing_com_height)
            # That is a height above the foothold.
            highest += state.ground(other(state.stance)) + swing.rise - state.ground(state.stance)

        feet: dict[Side, FootReference] = {
            state.stance: self._stance_foot(state, command, swing),
            other(state.stance): self._other_foot(state, command, swing, rate),
        }
        next_state, height = self._height(state, command.forward, highest)
        next_state = next_state._replace(
            elapsed=state.elapsed + rate * self.period,
            swing=swing,
            path=state.path.advanced(command, self.period),
        )
        return next_state, self._reference(state, body, zmp, xi, xi_reference, height, feet, foothold_W)

    def _swing_on(self, state: PlannerState, swing: Swing, goal: complex, rate: float, command: Command) -> Swing:
        """The swing one tick later, on its way to a foothold that may have moved."""
        timing, placement, law = self.parameters.timing, self.parameters.placement, self.parameters.swing
        remaining = timing.step - state.elapsed
        if remaining > placement.freeze:
            is_first = state.elapsed - timing.double_support < 0.5 * self.period
            share = 1.0 if is_first else self.period / (self.period + placement.smoothing)
            foothold = swing.foothold + share * (goal - swing.foothold)
            rise = height_at(self.terrain, foothold) - state.ground(other(state.stance))
            swing = swing._replace(foothold=foothold, rise=rise)
        pace = command.velocity * cmath.exp(1j * state.heading)
        landing = PlanarMotion(swing.foothold, law.landing_pace * pace, -law.landing_brake * pace)
        motion = swing.motion.towards(landing, remaining / rate, self.period, law.jerk_limit)
        stance, u = state.ankle(state.stance), cmath.exp(1j * state.heading)
        foot, foothold = (swing.motion.position - stance) / u, (swing.foothold - stance) / u
        if (way_round := placement.way_round(foot, foothold, state.stance)) is not None:
            passing, share = PlanarMotion(stance + u * way_round[0]), way_round[1]
            aside = swing.motion.towards(passing, share * remaining / rate, self.period, law.jerk_limit)
            motion = motion.with_sideways_of(aside, state.heading)
        return swing._replace(motion=motion)

    def _gait(self, state: PlannerState, command: Command) -> PeriodicGait:
        """The periodic walk that is wanted now: as commanded, and a little towards the path."""
        p = self.parameters
        timing, placement = p.timing, p.placement
        speed = command.velocity + state.to_path
        move = speed * timing.step
        turn = state.turn * timing.step
        # Sideways, one of the two half-steps is narrower by the way of a step.
        width = max(placement.width, placement.narrowest + abs(move.imag))
        half = 0.5j * width * (1.0 + cmath.exp(1j * turn))
        along = move * cmath.exp(0.5j * turn)
        return PeriodicGait(
            displacement=HalfSteps(left=along - half, right=along + half),
            turn=turn,
            roll_start=0.0,
            # Who goes backward sets his feet flat.
            roll_end=p.support.roll * complex(max(command.forward, 0.0), command.sideways),
            double_support=timing.double_support,
            single_support=timing.step - timing.double_support,
        )

    def _segments_left(self, state: PlannerState, gait: PeriodicGait) -> tuple[ZmpSegment, ...]:
        """The zero-moment point from now to the end of the step, over the feet as they stand."""
        timing = self.parameters.timing
        u = cmath.exp(1j * state.heading)
        stance = self.parameters.support.middle_of(state.ankle(state.stance), state.heading)
        single = ZmpSegment(stance + gait.roll_start * u, stance + gait.roll_end * u, gait.single_support)
        if state.phase is Phase.SINGLE_SUPPORT:
            return (single.rest(state.elapsed - timing.double_support),)
        old = self.parameters.support.middle_of(state.ankle(other(state.stance)), state.old_heading)
        old_end = old + gait.roll_end * cmath.exp(1j * state.old_heading)
        return (ZmpSegment(old_end, single.start, timing.double_support).rest(state.elapsed), single)

    def _stance_foot(self, state: PlannerState, command: Command, swing: Swing | None) -> FootReference:
        timing, rockers = self.parameters.timing, self.parameters.rockers
        if state.walked > 0 and state.elapsed < rockers.heel:
            return rockers.over_heel(state.heading)
        if swing is not None and self._heel_is_up(state, command, swing):
            since = state.elapsed - (timing.step - rockers.ball)
            pace = self._pace(state, swing.foothold - state.ankle(state.stance), command)
            return rockers.over_ball(since, timing.double_support, 1.0, state.heading, pace)
        return FootReference(FootTask.FLAT, 1.0, state.heading)

    def _other_foot(self, state: PlannerState, command: Command, swing: Swing | None, rate: float) -> FootReference:
        timing, rockers = self.parameters.timing, self.parameters.rockers
        if swing is None:
            load = max(1.0 - state.elapsed / timing.double_support, 0.0)
            pace = self._pace(state, state.ankle(state.stance) - state.ankle(other(state.stance)), command)
            if rockers.rises(pace):
                since = rockers.ball + state.elapsed
                return rockers.over_ball(since, timing.double_support, load, state.old_heading, pace)
            return FootReference(FootTask.FLAT, load, state.old_heading)
        progress = self._progress(state)
        profile = swing.profile.at(progress)
        progress_rate = rate / (timing.step - timing.double_support)
        share, slope, curvature = quintic_blend(clip(progress, 0.0, 1.0))
        rise = (share, slope * progress_rate, curvature * progress_rate**2)
        relaxed, relaxing, _ = quintic_blend(clip(progress / TOES_RELAXED, 0.0, 1.0))
        relaxing *= progress_rate / TOES_RELAXED
        goal_yaw = state.heading + state.turn * timing.step
        return FootReference(
            FootTask.SWING,
            0.0,
            swing.start_yaw + share * wrapped(goal_yaw - swing.start_yaw),
            swing.motion,
            (
                profile.height + swing.rise * rise[0],
                rate * profile.height_rate + swing.rise * rise[1],
                rate**2 * profile.height_acceleration + swing.rise * rise[2],
            ),
            (profile.pitch, rate * profile.pitch_rate, rate**2 * profile.pitch_acceleration),
            (swing.start_toes * (1.0 - relaxed), -swing.start_toes * relaxing),
        )

    def _pace(self, state: PlannerState, step: complex, command: Command) -> float:
        """Forward speed that a step [m] fits to: that of the command, or less if the step is short, or backward.

        A foot that leaves from under the body must not be steep, or its toes catch the ground.
        """
        along = (step * cmath.exp(-1j * state.heading)).real
        return min(command.forward, SHORT_STEP * along / self.parameters.timing.step)

    def _heel_is_up(self, state: PlannerState, command: Command, swing: Swing) -> bool:
        timing, rockers = self.parameters.timing, self.parameters.rockers
        pace = self._pace(state, swing.foothold - state.ankle(state.stance), command)
        return state.elapsed > timing.step - rockers.ball and rockers.rises(pace)

    def _height(
        self, state: PlannerState, forward_speed: float, highest: float = math.inf
    ) -> tuple[PlannerState, tuple[float, float, float]]:
        """Height of the center of mass: the ground under the support, a mean that follows the phase, and an arc.

        The mean goes down to `highest` if it has to.
        """
        law = self.parameters.height
        if state.phase is Phase.STAND:
            goal = law.standing * self.standing_com_height
        else:
            goal = law.walking * self.standing_com_height - law.below_top(forward_speed)
        stretched = goal > highest
        goal = min(goal, highest)
        height, rate, acceleration = law.approach(state.height, state.height_rate, goal, self.period, stretched)
        above = law.arc(state.elapsed, self.parameters.timing.step, forward_speed)
        support = self._support(state)
        reference = (
            support[0] + state.height + above[0],
            support[1] + state.height_rate + above[1],
            support[2] + acceleration + above[2],
        )
        return state._replace(height=height, height_rate=rate), reference

    # Both.

    def _support(self, state: PlannerState) -> tuple[float, float, float]:
        """Height of the ground under the support, with rate and acceleration [m, m/s, m/s2].

        That under the stance foot, or in standing between the feet; it is approached from that of the phase before.
        """
        timing = self.parameters.timing
        start, end = state.support_start, state.ground(state.stance)
        if state.phase is Phase.STAND:
            end = 0.5 * (state.right_ground + state.left_ground)
        duration = timing.weight_shift if state.phase is Phase.WEIGHT_SHIFT else timing.double_support
        share, slope, curvature = quintic_blend(min(state.elapsed / duration, 1.0))
        rise = end - start
        return start + rise * share, rise * slope / duration, rise * curvature / duration**2

    def _supported(self, state: PlannerState, zmp: complex, both: bool, on_ball: bool = False) -> complex:
        """The zero-moment point, kept over the stance foot or its front, or over both feet and between."""
        stance, old = state.ankle(state.stance), state.ankle(other(state.stance))
        return self.parameters.support.supported(zmp, stance, state.heading, old if both else None, on_ball)

    def _reference(
        self,
        state: PlannerState,
        body: BodyState,
        zmp: complex,
        xi: complex,
        xi_reference: complex,
        height: tuple[float, float, float],
        feet: dict[Side, FootReference],
        foothold: complex,
    ) -> WalkingReference:
        rotation = self.parameters.rotation
        u = cmath.exp(1j * state.heading)
        lead = ((body.left.position - body.right.position) / u).real
        lead_rate = ((body.left.velocity - body.right.velocity) / u).real
        swing, swing_rate = rotation.arms * lead, rotation.arms * lead_rate
        is_stepping = state.phase in (Phase.DOUBLE_SUPPORT, Phase.SINGLE_SUPPORT)
        turned = state.turn * (state.elapsed - 0.5 * self.parameters.timing.step) if is_stepping else 0.0
        facing = state.heading + turned
        return WalkingReference(
            phase=state.phase,
            phase_time=state.elapsed,
            zmp=zmp,
            dcm=xi,
            dcm_reference=xi_reference,
            com_height=height,
            ground_height=self._support(state)[0],
            right=feet["Right"],
            left=feet["Left"],
            pelvis_yaw=facing - rotation.pelvis * lead,
            chest_yaw=facing + rotation.chest * lead,
            shoulder_flexion=((swing, swing_rate), (-swing, -swing_rate)),
            foothold=foothold,
        )
