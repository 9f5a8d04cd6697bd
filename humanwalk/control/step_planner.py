"""When and where to step, and what the body should do meanwhile, so that the walker stays on its feet.

A clock goes through double and single support. The divergent component of motion (DCM) that is measured is compared
with that of the periodic walk which is wanted: what the ankle can mend moves the zero-moment point under the foot,
what it cannot mend moves the next foothold, and what no foothold within reach can mend hastens the step.

Points of the ground plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from enum import Enum

from humanwalk.body import SIDES, Side
from humanwalk.control.lipm import (
    GRAVITY,
    HalfSteps,
    PeriodicGait,
    ZmpSegment,
    backward,
    divergent_component,
    forward,
    natural_frequency,
)
from humanwalk.control.swing_foot import PlanarMotion, SwingParameters, SwingProfile
from humanwalk.quantity import quantity


class Phase(Enum):
    """What the walker is at."""

    STAND = 0
    WEIGHT_SHIFT = 1
    DOUBLE_SUPPORT = 2
    SINGLE_SUPPORT = 3


class FootTask(Enum):
    """What a foot is at."""

    FLAT = 0
    HEEL_STRIKE = 1
    HEEL_OFF = 2
    SWING = 3


@dataclass(frozen=True)
class StepTiming:
    """Durations of a step."""

    step: float = quantity(0.52, "s", 0.3, 1.2)
    """From touchdown to touchdown of the other foot."""

    double_support: float = quantity(0.10, "s", 0.04, 0.4)
    """Both feet carry: the beginning of the step."""

    weight_shift: float = quantity(1.0, "s", 0.3, 3.0)
    """From quiet standing onto the first stance foot."""

    heel_off: float = quantity(0.08, "s", 0.0, 0.3)
    """The heel rises this long before the other foot lands."""

    heel_strike: float = quantity(0.15, "s", 0.02, 0.4)
    """A foot that landed on its heel is flat after this time."""

    early_touchdown: float = quantity(0.7, "", 0.3, 1.0)
    """Share of the single support after which a touch of the ground ends it."""

    touchdown_force: float = quantity(60.0, "N", 5.0, 500.0)
    """Vertical force that counts as a touch."""

    hurry: float = quantity(15.0, "1/m", 0.0, 100.0)
    """Extra rate of the clock per metre by which the foothold that balance wants is out of reach."""

    hurry_limit: float = quantity(0.8, "", 0.0, 3.0)
    """Greatest extra rate of the clock."""


@dataclass(frozen=True)
class StepPlacement:
    """Where feet go and what the ground takes."""

    width: float = quantity(0.16, "m", 0.08, 0.4)
    """Between the lines of the two feet."""

    narrowest: float = quantity(0.09, "m", 0.0, 0.3)
    """Least sideways distance of a foothold from the stance foot: below, the legs would cross."""

    widest: float = quantity(0.65, "m", 0.2, 1.0)
    """Greatest sideways distance."""

    longest: float = quantity(1.0, "m", 0.2, 1.5)
    """Greatest distance forward or backward."""

    hurry_narrower: float = quantity(0.07, "m", 0.0, 0.3)
    """The clock hurries when the foothold that balance wants would miss `narrowest` by more than this."""

    hurry_wider: float = quantity(0.35, "m", 0.2, 1.0)
    """The clock hurries when that foothold is farther sideways than this."""

    smoothing: float = quantity(0.02, "s", 0.0, 0.2)
    """Time constant of the foothold."""

    freeze: float = quantity(0.04, "s", 0.0, 0.2)
    """The foothold is settled this long before touchdown."""

    ankle_to_middle: float = quantity(0.03, "m", -0.05, 0.1)
    """From the ankle forward to the point of the foot on which the pendulum stands."""

    roll_end: float = quantity(0.17, "s", 0.0, 0.3)
    """Zero-moment point when single support ends, before the point on which the pendulum stands, per speed."""

    foot_back: float = quantity(0.04, "m", 0.0, 0.1)
    """The zero-moment point stays this near behind the ankle."""

    ball: float = quantity(0.09, "m", 0.0, 0.2)
    """The zero-moment point stays this far before the ankle while the heel is up."""

    foot_front: float = quantity(0.2, "m", 0.0, 0.4)
    """And this near before it."""

    foot_half_width: float = quantity(0.03, "m", 0.0, 0.1)
    """And this near beside it."""


@dataclass(frozen=True)
class StepPlannerParameters:
    """How the walker steps and balances."""

    timing: StepTiming = StepTiming()
    placement: StepPlacement = StepPlacement()
    swing: SwingParameters = SwingParameters()

    height_share: float = quantity(0.935, "", 0.8, 1.0)
    """Height of the centre of mass in walking, as a share of its height in straight standing."""

    standing_height_share: float = quantity(0.985, "", 0.8, 1.0)
    """The same in quiet standing."""

    height_time: float = quantity(0.25, "s", 0.02, 2.0)
    """Time constant with which the height changes between standing and walking."""

    vertical_swing: float = quantity(0.01, "m", 0.0, 0.05)
    """Amplitude of the centre of mass at 1 m/s; grows with the square of the speed."""

    dcm_gain: float = quantity(1.0, "", 0.0, 5.0)
    """The error of the DCM shrinks at this many times the pendulum's own rate, while the foot is long enough."""

    speed_gain: float = quantity(0.05, "", 0.0, 1.0)
    """Share of the speed error over two steps by which the next step is faster."""

    speed_bias_limit: float = quantity(0.3, "m/s", 0.0, 1.0)
    """Greatest sum of such corrections."""

    lane_gain: float = quantity(0.3, "1/s", 0.0, 2.0)
    """Sideways speed per distance from the commanded path."""

    lane_speed_limit: float = quantity(0.1, "m/s", 0.0, 0.5)
    """Greatest such sideways speed."""

    heel_off_pitch: float = quantity(0.7, "rad", 0.0, 1.2)
    """Pitch of the foot that leaves, at the end of double support at 1 m/s and faster; in proportion below."""

    pelvis_turn: float = quantity(0.2, "rad/m", 0.0, 1.0)
    """Turn of the pelvis with the leading leg, per distance between the feet."""

    chest_turn: float = quantity(0.15, "rad/m", 0.0, 1.0)
    """Turn of the chest against it."""

    arm_swing: float = quantity(0.6, "rad/m", 0.0, 2.0)
    """Flexion of the shoulder opposite to the leading leg, per distance between the feet."""

    stop_speed: float = quantity(0.05, "m/s", 0.0, 0.3)
    """A step that is commanded slower than this is the last."""


@dataclass(frozen=True)
class Command:
    """What the walker is asked for, seen along its own heading: speeds [m/s] and turn rate [rad/s]."""

    forward: float = 0.0
    sideways: float = 0.0
    turn: float = 0.0

    @property
    def speed(self) -> complex:
        """Forward and sideways as one complex number."""
        return complex(self.forward, self.sideways)


@dataclass(frozen=True)
class FootState:
    """A foot as it is. Its frame sits at the ankle, parallel to the world when it stands flat and faces +x.

    position, velocity: of the ankle over ground, complex [m, m/s].
    height, height_rate: of the ankle [m, m/s].
    yaw, pitch, pitch_rate: [rad, rad/s], toes down positive.
    force: vertical force from the ground [N].
    """

    position: complex
    velocity: complex
    height: float
    height_rate: float
    yaw: float
    pitch: float
    pitch_rate: float
    force: float


@dataclass(frozen=True)
class BodyState:
    """What the planner knows of the body: time [s], centre of mass over ground and above it [m, m/s], the feet."""

    time: float
    com: complex
    com_velocity: complex
    com_height: float
    right: FootState
    left: FootState

    def foot(self, side: Side) -> FootState:
        """One foot."""
        return self.right if side == "Right" else self.left


@dataclass(frozen=True)
class FootReference:
    """What a foot should do.

    task: see `FootTask`; it says which of the others count.
    load: largest share of its strength that the foot may press with, 0 to 1.
    position, height: of the ankle over ground and above it, with rates and accelerations (swing).
    yaw, pitch: of the foot; the rates and accelerations are the pitch's.
    """

    task: FootTask
    load: float
    yaw: float
    position: PlanarMotion = PlanarMotion(0.0)
    height: tuple[float, float, float] = (0.0, 0.0, 0.0)
    pitch: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class WalkingReference:
    """What the body should do now.

    phase, phase_time: what the walker is at, and for how long [s].
    zmp: zero-moment point [m].
    dcm, dcm_reference: measured and nominal [m], for records.
    com_height: of the centre of mass, with rate and acceleration [m, m/s, m/s2].
    right, left: the feet.
    pelvis_yaw, chest_yaw: [rad].
    shoulder_flexion, elbow_flexion: angle and rate of right, then left [rad, rad/s].
    foothold: where the swinging foot's ankle is going [m].
    """

    phase: Phase
    phase_time: float
    zmp: complex
    dcm: complex
    dcm_reference: complex
    com_height: tuple[float, float, float]
    right: FootReference
    left: FootReference
    pelvis_yaw: float
    chest_yaw: float
    shoulder_flexion: tuple[tuple[float, float], tuple[float, float]]
    foothold: complex

    def foot(self, side: Side) -> FootReference:
        """One foot."""
        return self.right if side == "Right" else self.left


@dataclass(frozen=True)
class Swing:
    """The foot in the air: its way over ground, its profile and the foothold it is going to."""

    motion: PlanarMotion
    profile: SwingProfile
    foothold: complex
    start_yaw: float


@dataclass(frozen=True)
class Landing:
    """A touchdown: when [s], the middle between the feet then [m], the forward speed that was commanded [m/s]."""

    time: float
    middle: complex
    speed: float


@dataclass(frozen=True)
class PlannerState:
    """What the planner remembers from tick to tick.

    phase; elapsed: in the phase for standing and shift, in the step for double and single support [s].
    stance: the foot that carries in this step.
    right, left: ankles as they stand [m]; the swinging foot's is where it stood.
    heading, old_heading: of this step and of the one before [rad].
    path: the point of the commanded path beside the walker [m].
    height, height_rate: of the centre of mass without its swing [m, m/s].
    speed_bias: added to the commanded speed [m/s].
    landings: the last two.
    walked: steps since standing.
    swing: of the foot in the air.
    """

    phase: Phase
    elapsed: float
    stance: Side
    right: complex
    left: complex
    heading: float
    old_heading: float
    path: complex
    height: float
    height_rate: float = 0.0
    speed_bias: float = 0.0
    landings: tuple[Landing, ...] = ()
    walked: int = 0
    swing: Swing | None = None

    def ankle(self, side: Side) -> complex:
        """Where a foot stands."""
        return self.right if side == "Right" else self.left

    @property
    def middle(self) -> complex:
        """Between the ankles."""
        return 0.5 * (self.right + self.left)


def other(side: Side) -> Side:
    """The other side."""
    return "Left" if side == "Right" else "Right"


class StepPlanner:
    """The planner's law: a pure function from its state, the body and the command to the next state and a reference.

    Args:
        parameters: see there.
        standing_com_height: height of the centre of mass in straight standing [m].
        ankle_height: height of the ankle of a flat foot [m].
        first_swing: the foot that swings first.
        period: time between two ticks [s].
    """

    def __init__(
        self,
        parameters: StepPlannerParameters,
        standing_com_height: float,
        ankle_height: float,
        first_swing: Side,
        period: float,
    ) -> None:
        self.parameters = parameters
        self.standing_com_height = standing_com_height
        self.frequency = natural_frequency(parameters.height_share * standing_com_height)
        self.ankle_height = ankle_height
        self.first_swing = first_swing
        self.period = period

    def start(self, body: BodyState) -> PlannerState:
        """Standing on both feet, which face the same way."""
        heading = 0.5 * (body.right.yaw + body.left.yaw)
        middle = 0.5 * (body.right.position + body.left.position)
        return PlannerState(
            phase=Phase.STAND,
            elapsed=0.0,
            stance=other(self.first_swing),
            right=body.right.position,
            left=body.left.position,
            heading=heading,
            old_heading=heading,
            path=middle,
            height=body.com_height,
        )

    def update(self, state: PlannerState, body: BodyState, command: Command) -> tuple[PlannerState, WalkingReference]:
        """One tick: the next state, and what the body should do until then."""
        xi = divergent_component(body.com, body.com_velocity, self.frequency)
        state = self._transition(state, body, command)
        if state.phase in (Phase.STAND, Phase.WEIGHT_SHIFT):
            return self._stand(state, body, command, xi)
        return self._step(state, body, command, xi)

    # Phases.

    def _transition(self, state: PlannerState, body: BodyState, command: Command) -> PlannerState:
        timing = self.parameters.timing
        moving = abs(command.speed) > self.parameters.stop_speed or abs(command.turn) > self.parameters.stop_speed
        if state.phase is Phase.STAND and moving:
            return replace(state, phase=Phase.WEIGHT_SHIFT, elapsed=0.0)
        if state.phase is Phase.WEIGHT_SHIFT and state.elapsed >= timing.weight_shift:
            # The shift is the first step's double support: the foot that was left carries nothing any more.
            return self._lift_off(replace(state, elapsed=timing.double_support), body, command)
        if state.phase is Phase.DOUBLE_SUPPORT and state.elapsed >= timing.double_support:
            return self._lift_off(state, body, command)
        if state.phase is Phase.SINGLE_SUPPORT and self._has_landed(state, body):
            return self._touch_down(state, body, command, moving)
        return state

    def _has_landed(self, state: PlannerState, body: BodyState) -> bool:
        timing = self.parameters.timing
        progress = (state.elapsed - timing.double_support) / (timing.step - timing.double_support)
        touches = body.foot(other(state.stance)).force > timing.touchdown_force
        return progress >= 1.0 or (progress > timing.early_touchdown and touches)

    def _lift_off(self, state: PlannerState, body: BodyState, command: Command) -> PlannerState:
        timing = self.parameters.timing
        foot = body.foot(other(state.stance))
        profile = SwingProfile.from_lift_off(
            foot.height,
            foot.height_rate,
            foot.pitch,
            foot.pitch_rate,
            self.ankle_height,
            self.parameters.swing.toe_up * self._briskness(command),
            timing.step - timing.double_support,
            self.parameters.swing,
        )
        swing = Swing(PlanarMotion(foot.position, foot.velocity), profile, foot.position, foot.yaw)
        return replace(state, phase=Phase.SINGLE_SUPPORT, swing=swing)

    def _touch_down(self, state: PlannerState, body: BodyState, command: Command, moving: bool) -> PlannerState:
        """The swinging foot becomes the stance foot; both are where they are measured, so that no error adds up."""
        right, left = body.right.position, body.left.position
        middle = 0.5 * (right + left)
        heading = state.heading + command.turn * state.elapsed
        bias = state.speed_bias
        if len(state.landings) == 2:
            two_ago = state.landings[0]
            walked = (middle - two_ago.middle) * cmath.exp(-0.5j * (heading + state.old_heading))
            measured = walked.real / (body.time - two_ago.time)
            bias += self.parameters.speed_gain * (two_ago.speed - measured)
            bias = _clip(bias, -self.parameters.speed_bias_limit, self.parameters.speed_bias_limit)
        path = state.path + command.speed * state.elapsed * cmath.exp(1j * heading)
        path += ((middle - path) * cmath.exp(-1j * heading)).real * cmath.exp(1j * heading)
        return PlannerState(
            phase=Phase.DOUBLE_SUPPORT if moving else Phase.STAND,
            elapsed=0.0,
            stance=other(state.stance),
            right=right,
            left=left,
            heading=heading,
            old_heading=state.heading,
            path=path,
            height=state.height,
            height_rate=state.height_rate,
            speed_bias=bias if moving else 0.0,
            landings=(*state.landings[-1:], Landing(body.time, middle, command.forward)) if moving else (),
            walked=state.walked + 1 if moving else 0,
        )

    # Standing.

    def _stand(
        self, state: PlannerState, body: BodyState, command: Command, xi: complex
    ) -> tuple[PlannerState, WalkingReference]:
        """Keep the DCM in the middle, or bring it to where the first step begins."""
        u = cmath.exp(1j * state.heading)
        reference, rate = state.middle + self.parameters.placement.ankle_to_middle * u, 0.0 + 0.0j
        if state.phase is Phase.WEIGHT_SHIFT:
            gait = self._gait(state, command)
            stance_is_left = state.stance == "Left"
            segments = gait.segments(stance_is_left)[1:]
            ends = gait.end_offsets(self.frequency)
            goal = backward(segments, ends.left if stance_is_left else ends.right, self.frequency) * u
            goal += self._middle_of(state.ankle(state.stance), state.heading)
            blend, slope = _blend(state.elapsed / self.parameters.timing.weight_shift)
            rate = slope * (goal - reference) / self.parameters.timing.weight_shift
            reference += blend * (goal - reference)
        zmp = self._supported(
            state, reference - rate / self.frequency + (1.0 + self.parameters.dcm_gain) * (xi - reference), both=True
        )
        feet: dict[Side, FootReference] = {side: FootReference(FootTask.FLAT, 1.0, state.heading) for side in SIDES}
        next_state = replace(state, elapsed=state.elapsed + self.period)
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
        ends = gait.end_offsets(self.frequency)
        stance_point = self._middle_of(state.ankle(state.stance), state.heading)
        end = stance_point + u * (ends.left if stance_is_left else ends.right)

        segments = self._segments_left(state, gait)
        zmp_reference = segments[0].start
        xi_reference = backward(segments, end, self.frequency)
        zmp = self._supported(
            state,
            zmp_reference + (1.0 + self.parameters.dcm_gain) * (xi - xi_reference),
            both=state.phase is Phase.DOUBLE_SUPPORT,
            on_ball=state.phase is Phase.SINGLE_SUPPORT and self._heel_is_up(state, command),
        )

        rate = 1.0
        swing = state.swing
        if state.phase is Phase.SINGLE_SUPPORT and swing is not None:
            remaining = timing.step - state.elapsed
            error = (forward(segments, xi, self.frequency) - end) / u
            wanted = (gait.displacement.left if stance_is_left else gait.displacement.right) + self._kappa() * error
            foothold, beyond = self._within_reach(wanted, stance_is_left)
            rate += min(timing.hurry * beyond, timing.hurry_limit)
            if remaining > self.parameters.placement.freeze:
                goal = state.ankle(state.stance) + u * foothold
                share = self.period / (self.period + self.parameters.placement.smoothing)
                is_first = state.elapsed - timing.double_support < 0.5 * self.period
                goal = goal if is_first else swing.foothold + share * (goal - swing.foothold)
                swing = replace(swing, foothold=goal)
            motion = swing.motion.towards(
                swing.foothold, remaining / rate, self.period, self.parameters.swing.jerk_limit
            )
            swing = replace(swing, motion=motion)

        feet: dict[Side, FootReference] = {
            state.stance: self._stance_foot(state, command),
            other(state.stance): self._other_foot(state, command, swing, rate),
        }
        foothold_W = swing.foothold if swing is not None else state.ankle(other(state.stance))
        next_state, height = self._height(state, command.forward)
        next_state = replace(next_state, elapsed=state.elapsed + rate * self.period, swing=swing)
        return next_state, self._reference(state, body, zmp, xi, xi_reference, height, feet, foothold_W)

    def _gait(self, state: PlannerState, command: Command) -> PeriodicGait:
        """The periodic walk that is wanted now: as commanded, and a little towards the path."""
        p = self.parameters
        timing, placement = p.timing, p.placement
        u = cmath.exp(1j * state.heading)
        off_path = ((state.middle - state.path) / u).imag
        lane = _clip(-p.lane_gain * off_path, -p.lane_speed_limit, p.lane_speed_limit)
        speed = complex(command.forward + state.speed_bias, command.sideways + lane)
        move = speed * timing.step
        turn = command.turn * timing.step
        # Sideways, one of the two half-steps is narrower by the way of a step.
        width = max(placement.width, placement.narrowest + abs(move.imag))
        half = 0.5j * width * (1.0 + cmath.exp(1j * turn))
        along = move * cmath.exp(0.5j * turn)
        brisk = _clip(command.forward, 0.0, 2.0)
        return PeriodicGait(
            displacement=HalfSteps(left=along - half, right=along + half),
            turn=turn,
            roll_start=0.0,
            roll_end=placement.roll_end * brisk,
            double_support=timing.double_support,
            single_support=timing.step - timing.double_support,
        )

    def _segments_left(self, state: PlannerState, gait: PeriodicGait) -> tuple[ZmpSegment, ...]:
        """The zero-moment point from now to the end of the step, over the feet as they stand."""
        timing = self.parameters.timing
        u = cmath.exp(1j * state.heading)
        stance = self._middle_of(state.ankle(state.stance), state.heading)
        single = ZmpSegment(stance + gait.roll_start * u, stance + gait.roll_end * u, gait.single_support)
        if state.phase is Phase.SINGLE_SUPPORT:
            return (single.rest(state.elapsed - timing.double_support),)
        old = self._middle_of(state.ankle(other(state.stance)), state.old_heading)
        old_end = old + gait.roll_end * cmath.exp(1j * state.old_heading)
        return (ZmpSegment(old_end, single.start, timing.double_support).rest(state.elapsed), single)

    def _within_reach(self, wanted: complex, stance_is_left: bool) -> tuple[complex, float]:
        """The nearest foothold that legs reach without crossing, and by how much the wanted one calls for a hurry."""
        placement = self.parameters.placement
        outward = -1.0 if stance_is_left else 1.0
        width = outward * wanted.imag
        beyond = max(
            placement.narrowest - placement.hurry_narrower - width,
            width - placement.hurry_wider,
            abs(wanted.real) - 0.95 * placement.longest,
            0.0,
        )
        foothold = complex(
            _clip(wanted.real, -placement.longest, placement.longest),
            outward * _clip(width, placement.narrowest, placement.widest),
        )
        return foothold, beyond

    def _kappa(self) -> float:
        """How far the foothold follows the DCM's error at touchdown.

        The DCM counts from where the zero-moment point will be, which leaves the old foot only during double support.
        """
        wt = self.frequency * self.parameters.timing.double_support
        return wt / (1.0 - math.exp(-wt))

    def _stance_foot(self, state: PlannerState, command: Command) -> FootReference:
        timing = self.parameters.timing
        if state.walked > 0 and state.elapsed < timing.heel_strike:
            return FootReference(FootTask.HEEL_STRIKE, 1.0, state.heading)
        if self._heel_is_up(state, command):
            since = state.elapsed - (timing.step - timing.heel_off)
            return self._heel_off(since, 1.0, state.heading, command)
        return FootReference(FootTask.FLAT, 1.0, state.heading)

    def _other_foot(self, state: PlannerState, command: Command, swing: Swing | None, rate: float) -> FootReference:
        timing = self.parameters.timing
        if swing is None:
            load = max(1.0 - state.elapsed / timing.double_support, 0.0)
            if self._rises(command):
                return self._heel_off(timing.heel_off + state.elapsed, load, state.old_heading, command)
            return FootReference(FootTask.FLAT, load, state.old_heading)
        progress = (state.elapsed - timing.double_support) / (timing.step - timing.double_support)
        profile = swing.profile.at(progress)
        goal_yaw = state.heading + command.turn * timing.step
        return FootReference(
            FootTask.SWING,
            0.0,
            swing.start_yaw + _blend(progress)[0] * _wrapped(goal_yaw - swing.start_yaw),
            swing.motion,
            (profile.height, rate * profile.height_rate, rate**2 * profile.height_acceleration),
            (profile.pitch, rate * profile.pitch_rate, rate**2 * profile.pitch_acceleration),
        )

    def _heel_is_up(self, state: PlannerState, command: Command) -> bool:
        timing = self.parameters.timing
        return state.elapsed > timing.step - timing.heel_off and self._rises(command)

    def _rises(self, command: Command) -> bool:
        return self._briskness(command) > 0.5

    def _heel_off(self, since: float, load: float, yaw: float, command: Command) -> FootReference:
        duration = self.parameters.timing.heel_off + self.parameters.timing.double_support
        final = self.parameters.heel_off_pitch * self._briskness(command)
        s = min(since / duration, 1.0)
        pitch = (final * s * s, 2.0 * final * s / duration, 2.0 * final / duration**2)
        return FootReference(FootTask.HEEL_OFF, load, yaw, pitch=pitch)

    @staticmethod
    def _briskness(command: Command) -> float:
        """0 in standing or going backward, 1 at 1 m/s and faster."""
        return _clip(command.forward, 0.0, 1.0)

    def _height(self, state: PlannerState, forward_speed: float) -> tuple[PlannerState, tuple[float, float, float]]:
        """Height of the centre of mass: it sinks for walking, and is lowest in the middle of double support."""
        p = self.parameters
        share = p.standing_height_share if state.phase is Phase.STAND else p.height_share
        acceleration = (share * self.standing_com_height - state.height) / p.height_time**2
        acceleration -= 2.0 * state.height_rate / p.height_time
        next_rate = state.height_rate + self.period * acceleration
        next_state = replace(state, height=state.height + self.period * next_rate, height_rate=next_rate)
        amplitude = p.vertical_swing * forward_speed**2
        rate = 2.0 * math.pi / p.timing.step
        angle = rate * (state.elapsed - 0.5 * p.timing.double_support)
        return next_state, (
            state.height - amplitude * math.cos(angle),
            state.height_rate + amplitude * rate * math.sin(angle),
            acceleration + amplitude * rate**2 * math.cos(angle),
        )

    # Both.

    def _middle_of(self, ankle: complex, heading: float) -> complex:
        """The point of a foot on which the pendulum stands."""
        return ankle + self.parameters.placement.ankle_to_middle * cmath.exp(1j * heading)

    def _supported(self, state: PlannerState, zmp: complex, both: bool, on_ball: bool = False) -> complex:
        """The zero-moment point, kept over the stance foot or its front, or over both feet and between."""
        placement = self.parameters.placement
        anchor = state.ankle(state.stance)
        if both:
            old = state.ankle(other(state.stance))
            way = anchor - old
            along = ((zmp - old) * way.conjugate()).real / max(abs(way) ** 2, 1e-6)
            anchor = old + _clip(along, 0.0, 1.0) * way
        u = cmath.exp(1j * state.heading)
        local = (zmp - anchor) / u
        x = _clip(local.real, placement.ball if on_ball else -placement.foot_back, placement.foot_front)
        y = _clip(local.imag, -placement.foot_half_width, placement.foot_half_width)
        return anchor + u * complex(x, y)

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
        p = self.parameters
        u = cmath.exp(1j * state.heading)
        lead = ((body.left.position - body.right.position) / u).real
        lead_rate = ((body.left.velocity - body.right.velocity) / u).real
        swing, swing_rate = p.arm_swing * lead, p.arm_swing * lead_rate
        return WalkingReference(
            phase=state.phase,
            phase_time=state.elapsed,
            zmp=zmp,
            dcm=xi,
            dcm_reference=xi_reference,
            com_height=height,
            right=feet["Right"],
            left=feet["Left"],
            pelvis_yaw=state.heading - p.pelvis_turn * lead,
            chest_yaw=state.heading + p.chest_turn * lead,
            shoulder_flexion=((swing, swing_rate), (-swing, -swing_rate)),
            foothold=foothold,
        )


def com_acceleration(com: complex, zmp: complex, com_height: float, vertical_acceleration: float) -> complex:
    """Acceleration of the centre of mass over ground that puts the zero-moment point at `zmp` [m/s2]."""
    return (GRAVITY + vertical_acceleration) / com_height * (com - zmp)


def _clip(x: float, low: float, high: float) -> float:
    return min(max(x, low), high)


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def _blend(s: float) -> tuple[float, float]:
    """Quintic from 0 to 1 with its slope; rests at both ends."""
    s = _clip(s, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)) ** 2
