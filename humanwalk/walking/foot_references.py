"""References of the feet: the stance foot, the foot behind in double support, and the swinging foot."""

import math
from dataclasses import replace

from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip, wrapped
from humanwalk.terrain.face import surface_axes
from humanwalk.walking.command import Command
from humanwalk.walking.foot_rockers import Rollover
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.motions import blend
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState, Swing
from humanwalk.walking.walking_reference import FootReference, FootTask

SHORT_STEP = 1.2
"""A step is short if its length times this factor is less than speed times duration. Ordinary steps, which end early by
contact, are not (docs/balance_trials.md, "What do traced falls show?")."""

TOES_STRAIGHT = 0.6
"""Fraction of the swing after which the toes are straight: straightened at once they throw the foot up
(docs/balance_trials.md, "What makes a walk regular, straight and cheap?")."""


def rollover(
    state: PlannerState,
    start: Foothold,
    goal: Foothold,
    raised: float,
    command: Command,
    parameters: StepPlannerParameters,
) -> Rollover:
    """How a foot leaves the ground in the step from `start` to `goal`.

    Its speed is the commanded one, or less if the step is short for an ordinary one, or backward. A foot that is steep
    when it leaves the ground below the body catches the ground with its toes. In a step up or down it is large, and so
    it is before a swing that raises the foot: the ankle of a foot that rises behind the body does not bend so far that
    the foot could be level, nor does that of a foot below which the body sinks. A foot that is not behind the other one
    stays flat: on its ball it would push a body backward that has to step back.

    Args:
        state: State of the planner.
        start: Where the foot stands.
        goal: Where the other foot lands, or has landed.
        raised: Height by which the foot rises in its next swing [m].
        command: The command.
        parameters: Parameters of the planner.
    """
    length = ((goal.position - start.position) / state.direction).real
    swing = parameters.swing
    climbing = max(1.0 - swing.rolling_share(start.step_to(goal)), swing.raising_share(raised))
    climbing *= clip(length / parameters.placement.abreast, 0.0, 1.0)
    duration = parameters.timing.at_velocity(command.velocity).step
    ordinary = min(command.forward, SHORT_STEP * length / duration)
    speed = (1.0 - climbing) * ordinary + climbing * max(ordinary, parameters.rockers.full_pitch_speed)
    return Rollover(speed, heel_off_lead(start, goal, command.forward, parameters), climbing)


def heel_off_lead(start: Foothold, goal: Foothold, speed: float, parameters: StepPlannerParameters) -> float:
    """Time from heel-off to touchdown of the other foot in the step from `start` to `goal` at a forward speed [s].

    Before a step up, and onto another face, the heel stays on the ground: a walker on its toes cannot move the
    zero-moment point back, and on another face the foothold cannot follow the body. Before a step down it rises
    earlier, because the ankle bends no further while the body sinks.
    """
    swing, rockers, step = parameters.swing, parameters.rockers, start.step_to(goal)
    level = rockers.lead(speed) * swing.rolling_share(max(step, 0.0)) if start.face.covers_as(goal.face) else 0.0
    descent = swing.descent_share(step)
    return (1.0 - descent) * level + descent * rockers.descent


def stance_rollover(
    state: PlannerState, swing: Swing, command: Command, parameters: StepPlannerParameters
) -> tuple[Rollover, float]:
    """Rollover of the stance foot in single support, and the time since its heel-off [s].

    The time is negative before heel-off; minus infinity for a heel that does not rise.
    """
    raised = state.preview.raised[1]
    found = rollover(state, state.stance_foot, swing.foothold, raised, command, parameters)
    since = state.elapsed - (state.timing.step - found.lead)
    return found, since if parameters.rockers.heel_rises(found.speed) else -math.inf


def stance_foot(
    state: PlannerState, swing: Swing | None, command: Command, parameters: StepPlannerParameters
) -> FootReference:
    """Reference of the stance foot; `swing` is the swinging foot in single support."""
    timing, rockers = state.timing, parameters.rockers
    R_WS = state.stance_foot.R_WS
    if state.steps > 0 and state.elapsed < rockers.heel:
        level = parameters.swing.rolling_share(state.old_foot.step_to(state.stance_foot))
        return rockers.over_heel(level, state.heading, R_WS)
    if swing is None:
        return FootReference(FootTask.FLAT, 1.0, state.heading, R_WS)
    found, since = stance_rollover(state, swing, command, parameters)
    if since <= 0.0:
        return rockers.before_heel_off(-since, state.heading, R_WS, found)
    return rockers.over_ball(since, timing.double_support, 1.0, state.heading, R_WS, found)


def foot_behind(
    state: PlannerState, command: Command, parameters: StepPlannerParameters, is_passive: bool = False
) -> FootReference:
    """Reference of the foot that leaves the ground at the end of double support.

    Its force is limited in a step on one face only: on boxes of ±5 cm 2 of 40 walks fell with the limit. The force on a
    foot without muscles at the ankle is that of its spring: with the limit 4 of 10 walks with a prosthesis fell.

    Args:
        state: State of the planner.
        command: The command.
        parameters: Parameters of the planner.
        is_passive: Whether the foot has no muscles at the ankle.
    """
    timing, rockers = state.timing, parameters.rockers
    load, R_WS = max(1.0 - state.elapsed / timing.double_support, 0.0), state.old_foot.R_WS
    raised = state.preview.raised[0]
    found = rollover(state, state.old_foot, state.stance_foot, raised, command, parameters)
    is_limited = state.old_foot.face.covers_as(state.stance_foot.face) and not is_passive
    force = rockers.unloading_force if is_limited else math.inf
    if rockers.heel_rises(found.speed):
        # After an early touchdown of the other foot, a heel-off that has begun goes on without a jump.
        since = state.elapsed + max(found.lead - state.early, 0.0)
        foot = rockers.over_ball(since, timing.double_support, load, state.old_heading, R_WS, found)
    else:
        foot = FootReference(FootTask.FLAT, load, state.old_heading, R_WS)
    return replace(foot, force=force)


def swinging_foot(state: PlannerState, swing: Swing, phase_rate: float) -> FootReference:
    """Reference of the swinging foot at a rate of the clock."""
    timing = state.timing
    progress = timing.swing_progress(state.elapsed)
    progress_rate = phase_rate / timing.single_support
    height, pitch = swing.profile.at(progress)
    rise = blend(0.0, swing.rise, progress, 1.0).plus(swing.clearance.at(progress))
    toes = blend(swing.start_toes, 0.0, progress, TOES_STRAIGHT).time_scaled(progress_rate)
    turn = wrapped(state.heading + state.turn * timing.step - swing.start_yaw)
    return FootReference(
        FootTask.SWING,
        load=0.0,
        yaw=swing.start_yaw + blend(0.0, turn, progress, 1.0).value,
        R_WS=_turned(state.old_foot, swing.foothold, progress),
        position=swing.motion,
        height=height.plus(rise).time_scaled(progress_rate),
        pitch=pitch.time_scaled(progress_rate),
        toes=toes[:2],
    )


def _turned(start: Foothold, goal: Foothold, progress: float) -> Array:
    """R_WS of the foot's axes on the way from one face to another: their normals are interpolated."""
    if start.face.gradient == goal.face.gradient:
        return goal.R_WS
    s = blend(0.0, 1.0, progress, 1.0).value
    return surface_axes((1.0 - s) * start.face.normal + s * goal.face.normal).T
