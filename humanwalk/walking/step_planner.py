"""The step planner: balance by the zero-moment point, by the next foothold, and by the duration of the step.

The measured divergent component of motion (DCM) is compared with that of the desired periodic gait. The zero-moment
point corrects the error within the base of support, the next foothold corrects what remains at touchdown, and the clock
of the step runs faster if that foothold is out of reach. The equations are those of docs/balance.md.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

import math
from collections.abc import Collection
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from humanwalk.body.contact import SoleExtent
from humanwalk.sides import OUTWARD, SIDES, Side
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.command import Command
from humanwalk.walking.counter_rotation import foot_lead
from humanwalk.walking.foot_placement import foothold_gain
from humanwalk.walking.foot_references import foot_behind, stance_foot, stance_rollover, swinging_foot
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.height_planner import HeightPlanner, Touchdown
from humanwalk.walking.lipm import backward, com_after, divergent_component, forward, natural_frequency
from humanwalk.walking.motions import ScalarMotion, blend
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.phases import PhaseTransitions
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.preview import FootholdPlanner, dcm_shift
from humanwalk.walking.support import SupportMotion, support_motion
from humanwalk.walking.swing_motion import SwingGoal, advanced_swing
from humanwalk.walking.touch import standing_feet, touches
from humanwalk.walking.walking_reference import BodyState, FootReference, FootTask, Phase, WalkingReference
from humanwalk.walking.zmp_reference import (
    desired_gaits,
    foothold_moves,
    pivot_lead,
    remaining_pivot,
    turned,
)


class Balance(NamedTuple):
    """Zero-moment point, centroidal moment pivot, measured DCM and nominal DCM [m]."""

    zmp: complex
    pivot: complex
    dcm: complex
    dcm_reference: complex


class StepPlanner:
    """A pure function from planner state, body state and command to the next planner state and the reference.

    Args:
        parameters: Parameters of the planner.
        standing_com_height: Height of the center of mass above the ground with straight legs [m].
        ankle_height: Height of the ankle of a flat foot above the ground [m].
        leg_length: Distance of hip and ankle of a straight leg [m].
        first_swing: The foot of the first step.
        period: Control period [s].
        sole: Extent of a sole.
        ground: What is known of the ground.
        passive_ankles: Sides without muscles at the ankle.
    """

    def __init__(
        self,
        parameters: StepPlannerParameters,
        standing_com_height: float,
        ankle_height: float,
        leg_length: float,
        first_swing: Side,
        period: float,
        sole: SoleExtent,
        ground: Ground,
        passive_ankles: Collection[Side] = (),
    ) -> None:
        self.parameters = p = parameters
        com_height = p.height.walking * standing_com_height
        self.frequency = natural_frequency(com_height)
        self._period, self._sole, self._ankle_height = period, sole, ankle_height
        self._passive_ankles = passive_ankles
        self._footholds = FootholdPlanner(sole, p.footholds, p.placement, p.pacing, com_height)
        self._height = HeightPlanner(p, standing_com_height, leg_length, period)
        self._phases = PhaseTransitions(p, ankle_height, first_swing, ground, self._footholds, passive_ankles)

    def start(self, body: BodyState, heading: float = 0.0) -> PlannerState:
        """The state in standing; the commanded path begins along a heading [rad]."""
        return self._phases.start(body, heading)

    def update(self, state: PlannerState, body: BodyState, command: Command) -> tuple[PlannerState, WalkingReference]:
        """One control period: the next state, and the reference for the period."""
        dcm = divergent_component(body.com, body.com_velocity, self.frequency)
        state = self._phases.advance(self._feel(state, body), body, command, dcm)
        plan = self._step if state.is_stepping else self._stand
        next_state, reference = plan(state, body, command, dcm)
        # In standing a turn that is too slow for steps would add up.
        along = replace(command, turn=0.0) if state.phase is Phase.STAND else command
        return next_state._replace(path=state.path.advanced(along, self._period), zmp=reference.zmp), reference

    def _feel(self, state: PlannerState, body: BodyState) -> PlannerState:
        """The state with what the feet feel of the ground."""
        ground = state.ground.felt(touches(state, body, self.parameters, self._sole, self._ankle_height), self._period)
        if ground is state.ground:
            return state
        feet = {side: Foothold.on(ground, state.foot(side).position) for side in standing_feet(state)}
        return state._replace(ground=ground, right=feet.get("Right", state.right), left=feet.get("Left", state.left))

    def _stand(
        self, state: PlannerState, body: BodyState, command: Command, dcm: complex
    ) -> tuple[PlannerState, WalkingReference]:
        """Hold the DCM between the feet, or move it to where the first step begins."""
        p, timing = self.parameters, state.timing
        dcm_reference, dcm_rate = p.support.center_of(state.midpoint, state.heading), 0j
        if state.phase is Phase.WEIGHT_SHIFT:
            gait, *following = gaits = desired_gaits(state, state.preview.paced(command), p)
            end = gait.end_offset(state.stance, self.frequency, *following)
            end += dcm_shift(foothold_moves(state, gaits), following, self.frequency) / state.direction
            start = backward(gait.along_foot, end, self.frequency)
            change = state.world(p.support.center + start) - dcm_reference
            s = blend(0.0, 1.0, state.elapsed, timing.weight_shift)
            dcm_reference, dcm_rate = dcm_reference + s.value * change, s.rate * change
        zmp = self._clamp(state, dcm_reference - dcm_rate / self.frequency + (1.0 + p.dcm_gain) * (dcm - dcm_reference))
        balance = Balance(zmp, zmp, dcm, dcm_reference)
        feet: dict[Side, FootReference] = {
            side: FootReference(FootTask.FLAT, 1.0, state.heading, state.foot(side).R_WS) for side in SIDES
        }
        support = support_motion(state, 0.0, self.frequency)
        next_state, com_height = self._height.advanced(state, support)
        next_state = next_state._replace(elapsed=state.elapsed + self._period)
        return next_state, self._reference(state, body, balance, com_height, support, feet, state.midpoint, 0.0)

    def _step(
        self, state: PlannerState, body: BodyState, command: Command, dcm: complex
    ) -> tuple[PlannerState, WalkingReference]:
        """Balance and step in double or single support."""
        p, timing, placement, preview = self.parameters, state.timing, self.parameters.placement, state.preview
        state, command = turned(state, command), preview.paced(command)
        gait, *following = gaits = desired_gaits(state, command, p)
        moves = foothold_moves(state, gaits)

        # Nominal DCM: backward from its value at the end of the step, that of the gait on the next footholds.
        end = state.world(p.support.center + gait.end_offset(state.stance, self.frequency, *following))
        end += dcm_shift(moves, following, self.frequency)
        segments = remaining_pivot(state, gait, p)
        held = self._passive_pressure(state, body)
        if held is not None:
            segments = tuple(segment.moved(held - segments[0].start) for segment in segments)
        dcm_reference = backward(segments, end, self.frequency)

        # Pivot: feedback of the error of the DCM, with the zero-moment point within the base of support.
        gain = p.double_support_gain if state.phase is Phase.DOUBLE_SUPPORT else p.dcm_gain
        heel_is_up = state.swing is not None and stance_rollover(state, state.swing, command, p)[1] > 0.0
        pivot, lead = segments[0].start + (1.0 + gain) * (dcm - dcm_reference), pivot_lead(state, gait)
        zmp = self._clamp(state, pivot - lead, heel_is_up)
        pivot = zmp + lead
        if held is not None:
            zmp = pivot = held

        # Foothold: correction of the error that remains at touchdown.
        error = (forward(segments, dcm, self.frequency) - end) / state.direction
        sensitivity = foothold_gain(self.frequency, following[0].double_support)
        desired = gait.displacement.on(state.stance) + moves[0] / state.direction + sensitivity * error

        heights = [state.stance_foot.ground, *(foothold.ground for foothold in preview.footholds)]
        rises = tuple(after - before for before, after in pairwise(heights))
        support = support_motion(state, dcm_shift(rises, following, self.frequency).real, self.frequency)

        # Clock of the step and swinging foot: a foothold out of reach makes the clock run faster.
        foot, swing = state.local(body.foot(state.swing_side).position), state.swing
        if swing is None:
            excess = placement.double_support_excess(desired, state.stance, foot)
            # If the old foot left before the new one carries the weight, the body would fall.
            limit = timing.double_support_rate_limit * body.load_share(state.stance)
            phase_rate = timing.phase_rate(excess, limit)
            foothold, touchdown = state.old_foot, None
            other_foot = foot_behind(state, command, p, state.swing_side in self._passive_ankles)
        else:
            reachable, excess = placement.within_reach(desired, state.stance, foot)
            phase_rate = timing.phase_rate(excess, timing.phase_rate_limit)
            remaining = (timing.step - state.elapsed) / phase_rate
            com = com_after(remaining, body.com, dcm, pivot, self.frequency)
            local_com = state.local(com)
            goal = state.world(placement.near_com(reachable, local_com))
            # At touchdown the foot will have passed the stance foot.
            landing, _ = placement.within_reach(desired, state.stance, reachable)
            growth = math.expm1(self.frequency * (timing.step - state.elapsed))
            correctable = sensitivity * p.support.correctable(error, growth) * state.direction
            expected = state.world(placement.near_com(landing, local_com)) - correctable
            way = SwingGoal(goal, expected, remaining)
            swing = advanced_swing(state, swing, way, command, p, self._footholds, self._period)
            foothold = swing.foothold
            touchdown = Touchdown(foothold, com, support.after(remaining))
            other_foot = swinging_foot(state, swing, phase_rate)

        feet = {state.stance: stance_foot(state, swing, command, p), state.swing_side: other_foot}
        highest = self._height.highest(state, touchdown)
        next_state, com_height = self._height.advanced(state, support, command.forward, highest)
        elapsed, largest = state.elapsed + phase_rate * self._period, max(state.largest_error, abs(error))
        next_state = next_state._replace(elapsed=elapsed, swing=swing, largest_error=largest)
        balance = Balance(zmp, pivot, dcm, dcm_reference)
        return next_state, self._reference(
            state, body, balance, com_height, support, feet, foothold.position, command.forward
        )

    def _passive_pressure(self, state: PlannerState, body: BodyState) -> complex | None:
        """Center of pressure under a foot that alone supports the body, and that no ankle muscles turn; else None.

        Its spring, and not the planner, decides on it.
        """
        foot = body.foot(state.stance)
        is_passive = state.phase is Phase.SINGLE_SUPPORT and state.stance in self._passive_ankles
        if not is_passive or foot.force < self.parameters.timing.loaded_force:
            return None
        return complex(foot.pressure[0], foot.pressure[1])

    def _clamp(self, state: PlannerState, zmp: complex, heel_is_up: bool = False) -> complex:
        """The zero-moment point, limited to the base of support."""
        old = None if state.phase is Phase.SINGLE_SUPPORT else state.old_foot.position
        return self.parameters.support.clamp(zmp, state.stance_foot.position, state.heading, old, heel_is_up)

    def _reference(
        self,
        state: PlannerState,
        body: BodyState,
        balance: Balance,
        com_height: ScalarMotion,
        support: SupportMotion,
        feet: dict[Side, FootReference],
        foothold: complex,
        speed: float,
    ) -> WalkingReference:
        """The reference, with pelvis, chest and arms that rotate with the legs."""
        rotation, timing = self.parameters.rotation, state.timing
        lead, lead_rate = foot_lead(body, state.heading)
        right, left = (rotation.arms * freedom for freedom in body.arm_freedom)
        # The trunk turns at the rate of the path, the headings of the steps by one step's turn at touchdown.
        facing = state.heading + (state.turn * (state.elapsed - 0.5 * timing.step) if state.is_stepping else 0.0)
        return WalkingReference(
            phase=state.phase,
            phase_time=state.elapsed,
            zmp=balance.zmp,
            pivot=balance.pivot,
            dcm=balance.dcm,
            dcm_reference=balance.dcm_reference,
            com_height=com_height,
            ground_height=support.ground,
            right=feet["Right"],
            left=feet["Left"],
            pelvis_yaw=facing - rotation.pelvis * lead,
            pelvis_roll=OUTWARD[state.stance] * rotation.drop_at(state.elapsed / timing.step, speed),
            chest_yaw=facing + rotation.chest * lead,
            shoulder_flexion=((right * lead, right * lead_rate), (-left * lead, -left * lead_rate)),
            head_yaw=(-rotation.head * lead, -rotation.head * lead_rate),
            foothold=foothold,
            step_duration=timing.step,
            stance=state.stance,
            speed=speed,
            ground=state.ground,
        )
