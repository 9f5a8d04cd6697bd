"""The phases of the walk: when one ends, and the state in which the next one begins.

STAND -> WEIGHT_SHIFT -> SINGLE_SUPPORT <-> DOUBLE_SUPPORT, and from SINGLE_SUPPORT back to STAND. If standing
cannot hold the body, DOUBLE_SUPPORT follows.
"""

import cmath
from collections.abc import Collection, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.sides import other_side
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.command import Command
from humanwalk.walking.foot_references import foot_behind
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.lipm import PeriodicGait
from humanwalk.walking.motions import PlanarMotion
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState, Swing
from humanwalk.walking.preview import STEPS, FootholdPlanner, Preview
from humanwalk.walking.swing_clearance import TIMES, clearance
from humanwalk.walking.swing_foot import SwingProfile
from humanwalk.walking.touch import STANDING_TIME, first_touches
from humanwalk.walking.walking_reference import BodyState, Phase
from humanwalk.walking.zmp_reference import desired_gait

STOP_TURN = 0.0265
"""Commanded turn in the time of a step up to which a step is the last one [rad]."""

NO_PREVIEW = Preview()
"""The plan before the first step."""


class PhaseTransitions:
    """Transitions between the phases; the arguments are those of `StepPlanner`."""

    def __init__(
        self,
        parameters: StepPlannerParameters,
        ankle_height: float,
        first_swing: Side,
        ground: Ground,
        footholds: FootholdPlanner,
        passive_ankles: Collection[Side] = (),
    ) -> None:
        self._passive_ankles = passive_ankles
        self._parameters, self._ankle_height = parameters, ankle_height
        self._first_swing, self._ground, self._footholds = first_swing, ground, footholds

    def start(self, body: BodyState, heading: float) -> PlannerState:
        """Standing on both feet, at the start of a path along a heading [rad]."""
        ground = self._ground.felt(first_touches(body, self._footholds.sole, self._ankle_height), STANDING_TIME)
        right, left = (Foothold.on(ground, foot.position) for foot in (body.right, body.left))
        support = 0.5 * (right.ground + left.ground)
        return PlannerState(
            phase=Phase.STAND,
            elapsed=0.0,
            stance=other_side(self._first_swing),
            right=right,
            left=left,
            support=support,
            heading=heading,
            old_heading=heading,
            path=self._parameters.path.begin(0.5 * (right.position + left.position), heading),
            height=body.com_height - support,
            timing=self._parameters.timing,
            ground=ground,
        )

    def advance(self, state: PlannerState, body: BodyState, command: Command, dcm: complex) -> PlannerState:
        """The state after the transition that is due, if any, with the stance foot where it is measured."""
        return self._reanchor_airborne_stance(self._transition(state, body, command, dcm), body)

    def _transition(self, state: PlannerState, body: BodyState, command: Command, dcm: complex) -> PlannerState:
        timing = state.timing
        turn = abs(command.turn) * self._parameters.timing.step
        is_moving = abs(command.velocity) > self._parameters.stop_speed or turn > STOP_TURN
        if not state.is_stepping and self._is_lost(state, dcm):
            return self._catch(state, command, dcm)
        if state.phase is Phase.STAND and is_moving:
            state = state._replace(phase=Phase.WEIGHT_SHIFT, elapsed=0.0)
        if state.phase is Phase.WEIGHT_SHIFT:
            # The command may still change before the first step.
            timing = self._parameters.timing.at_velocity(command.velocity)
            ready = self._look_ahead(state._replace(timing=timing, caution=0.0), command)
            if state.elapsed < timing.weight_shift:
                return ready._replace(path_correction=state.path_correction)
            # The weight shift takes the place of the first double support.
            return self._lift_off(ready._replace(elapsed=ready.timing.double_support), body, command)
        if state.phase is Phase.DOUBLE_SUPPORT and state.elapsed >= timing.double_support:
            return self._lift_off(state, body, command)
        if state.phase is Phase.SINGLE_SUPPORT and timing.has_landed(state.elapsed, body.foot(state.swing_side).force):
            return self._touch_down(state, body, command, is_moving, dcm)
        return state

    def _lift_off(self, state: PlannerState, body: BodyState, command: Command) -> PlannerState:
        """The old foot begins to swing, with its measured position and velocity."""
        swing = self._parameters.swing
        swing = replace(swing, lift=self._parameters.caution.lift_above(swing.lift, state.caution))
        command = state.preview.paced(command)
        foot, goal = body.foot(state.swing_side), state.preview.footholds[0]
        flat_height = state.old_foot.ground + self._ankle_height / state.old_foot.R_WS[2, 2]
        toe_up = swing.touchdown_pitch(command.forward) * swing.rolling_share(state.stance_foot.step_to(goal))
        if state.swing_side in self._passive_ankles:
            # Nothing lifts its toes.
            toe_up = 0.0
        # In a weight shift both feet are flat, even one that is behind.
        has_rolled = state.phase is Phase.DOUBLE_SUPPORT
        toes = foot_behind(state, command, self._parameters).toes[0] if has_rolled else 0.0
        sole = self._footholds.sole
        sink_rate = swing.sink_rate(command.forward)
        profile = SwingProfile.from_toe_off(
            foot, flat_height, toe_up, sink_rate, state.timing.single_support, swing, sole
        )
        acceleration = swing.toe_off_acceleration(command.velocity * state.direction)
        return state._replace(
            phase=Phase.SINGLE_SUPPORT,
            swing=Swing(
                motion=PlanarMotion(foot.position, foot.velocity, acceleration),
                profile=profile,
                foothold=Foothold(foot.position, state.old_foot.ground, goal.face),
                start_yaw=foot.yaw,
                start=foot.position,
                lift_off=state.elapsed,
                lowest=np.array([profile.lowest(s, flat_height, sole) for s in TIMES.tolist()]),
                start_toes=toes,
            ),
        )

    def _touch_down(
        self, state: PlannerState, body: BodyState, command: Command, is_moving: bool, dcm: complex
    ) -> PlannerState:
        """The swinging foot becomes the stance foot.

        Both feet are set to their measured positions, so that errors do not accumulate. Heading and turn rate are those
        of the path beside the new stance foot.
        """
        right, left = (Foothold.on(state.ground, foot.position) for foot in (body.right, body.left))
        midpoint = 0.5 * (right.position + left.position)
        is_stepping = is_moving or not self._can_stand(right, left, state.heading, dcm)
        is_paused = self._lags(state, body, dcm)
        command = command.at_pace(0.0) if is_paused else command
        following = self._parameters.path
        path = following.limit_lead(state.path, state.path.nearest(midpoint, command), command)
        caution = self._parameters.caution.after(state.caution, state.largest_error)
        beside_foot = path.nearest(body.foot(state.swing_side).position, command)
        landed = PlannerState(
            phase=Phase.DOUBLE_SUPPORT if is_stepping else Phase.STAND,
            elapsed=0.0,
            stance=state.swing_side,
            right=right,
            left=left,
            support=state.support,
            heading=beside_foot.heading,
            old_heading=state.heading,
            path=path,
            turn=beside_foot.turn,
            next_turn=beside_foot.turn,
            path_correction=following.correction(path, path.nearest(midpoint, command), midpoint, command),
            height=state.height,
            height_rate=state.height_rate,
            steps=state.steps + 1 if is_stepping else 0,
            early=max(state.timing.step - state.elapsed, 0.0) if is_stepping else 0.0,
            timing=self._parameters.timing.at_velocity(command.velocity, caution),
            ground=state.ground,
            caution=caution,
        )
        return self._look_ahead(landed, command, state.preview, is_paused) if is_stepping else landed

    def _lags(self, state: PlannerState, body: BodyState, dcm: complex) -> bool:
        """Whether the DCM is behind the foot that lands on an irregular foothold, after a large error."""
        ahead = ((dcm - body.foot(state.swing_side).position) / state.direction).real
        is_large = state.largest_error >= self._parameters.caution.pause_error
        return state.preview.holds_command and is_large and ahead < self._parameters.support.center

    def _catch(self, state: PlannerState, command: Command, dcm: complex) -> PlannerState:
        """Begin a careful step from standing, on the foot with the smaller lateral distance to the DCM."""
        stance = min(SIDES, key=lambda side: abs(((dcm - state.foot(side).position) / state.direction).imag))
        careful = state._replace(
            phase=Phase.DOUBLE_SUPPORT,
            elapsed=0.0,
            stance=stance,
            timing=self._parameters.timing.at_velocity(command.velocity, 1.0),
            caution=1.0,
        )
        return self._look_ahead(careful, command)

    def _is_lost(self, state: PlannerState, dcm: complex) -> bool:
        """Whether the DCM is outside the base of support of both feet, where standing cannot hold the body."""
        outside = self._parameters.support.outside(dcm, state.right.position, state.heading, state.left.position)
        return abs(outside) > (self._parameters.shift_margin if state.phase is Phase.WEIGHT_SHIFT else 0.0)

    def _can_stand(self, right: Foothold, left: Foothold, heading: float, dcm: complex) -> bool:
        """Whether the feet are side by side, and their base of support contains the DCM."""
        p = self._parameters
        apart = (left.position - right.position) / cmath.exp(1j * heading) - 1j * p.placement.step_width
        return abs(apart) <= p.stand_spread and p.support.outside(dcm, right.position, heading, left.position) == 0.0

    def _look_ahead(
        self, state: PlannerState, command: Command, before: Preview = NO_PREVIEW, is_paused: bool = False
    ) -> PlannerState:
        """The state with the next footholds, and with caution, duration and speed of the step that suit them.

        Args:
            state: State at the beginning of a step.
            command: The command.
            before: What was planned in the step before.
            is_paused: Whether the command holds for this step on regular footholds, too.
        """
        gait, preview = self._preview(state, command, before)
        careful = self._cautious(state, command, preview)
        if careful is not state:
            state, (gait, preview) = careful, self._preview(careful, command, before)
        feet = (state.old_foot, state.stance_foot, *preview.footholds)
        swings = [(feet[k], feet[k + 2]) for k in range(STEPS)]
        rises = [goal.ground - start.ground for start, goal in swings]
        lifts = [self._added_lift(state, *swing) for swing in swings]
        factor, *others = map(self._parameters.pacing.duration_factor, rises, lifts)
        behind, stance = (self._raised(*swing, lift) for swing, lift in zip(swings[:2], lifts[:2], strict=True))
        preview = preview._replace(
            durations=tuple(other / factor for other in others),
            raised=(behind, stance),
            command=command if is_paused or not preview.is_regular else None,
        )
        if factor == 1.0 and preview.pace == 1.0:
            return state._replace(preview=preview)
        # A step that takes longer is not ahead by what the gait covers in that time.
        gained = (factor - 1.0) * abs(gait.displacement.on(state.stance).real)
        preview = preview._replace(ahead=max(preview.ahead - gained, 0.0))
        pace = preview.pace / factor
        return state._replace(
            timing=state.timing.stretched(factor),
            path_correction=complex(pace * state.path_correction.real, state.path_correction.imag),
            preview=preview._replace(pace=pace),
        )

    def _cautious(self, state: PlannerState, command: Command, preview: Preview) -> PlannerState:
        """The state with the caution that the next footholds require, if that is more, and with its timing."""
        caution = self._parameters.caution.on_ground(self._heights(state, preview))
        if caution <= state.caution:
            return state
        return state._replace(caution=caution, timing=self._parameters.timing.at_velocity(command.velocity, caution))

    def _preview(self, state: PlannerState, command: Command, before: Preview) -> tuple[PeriodicGait, Preview]:
        """The desired gait, and its next footholds."""
        gait = desired_gait(state, command, self._parameters)
        stance = (state.stance_foot, state.stance, state.heading)
        current = before.footholds[1].face if before.footholds else None
        return gait, self._footholds.preview(state.ground, *stance, gait, before.ahead, current)

    def _heights(self, state: PlannerState, preview: Preview) -> Iterator[float]:
        """Rises of the next steps above the plane of the foot behind, and heights of what they clear [m]."""
        feet = (state.old_foot, state.stance_foot, *preview.footholds)
        yield from (start.step_to(goal) for start, goal in pairwise(feet))
        yield self._added_lift(state, state.old_foot, preview.footholds[0])
        yield self._added_lift(state, state.stance_foot, preview.footholds[1])

    def _added_lift(self, state: PlannerState, start: Foothold, goal: Foothold) -> float:
        """Height [m] by which a foot is lifted higher than on a plane, without the margin."""
        law = self._parameters.clearance
        added = clearance(state.ground, start, goal, state.heading, self._footholds.sole, law)
        return max(max(added.lift) - law.margin, 0.0)

    def _raised(self, start: Foothold, goal: Foothold, lift: float) -> float:
        """Height by which a foot rises [m]: to its foothold, and by its lift over the ground; less in a step down."""
        step = start.step_to(goal)
        return (1.0 - self._parameters.swing.descent_share(step)) * (max(step, 0.0) + lift)

    def _reanchor_airborne_stance(self, state: PlannerState, body: BodyState) -> PlannerState:
        """A stance foot that has not touched the ground yet stands where it is now, not where its swing ended."""
        foot = body.foot(state.stance)
        is_landing = state.steps > 0 and 0.0 < state.elapsed <= self._parameters.rockers.heel
        if foot.force >= self._parameters.timing.loaded_force or not is_landing:
            return state
        foothold = Foothold.on(state.ground, foot.position)
        state = state._replace(preview=state.preview.shifted(foothold.position - state.stance_foot.position))
        return state._replace(right=foothold) if state.stance == "Right" else state._replace(left=foothold)
