"""When, where and why a walker fell, from the record and what pushed it.

The likely cause is the first of the events below in the last seconds before the body goes down: what comes later, as
feet that slide under a falling body, is usually a consequence.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypedDict

import numpy as np
import pyarrow as pa

from humanwalk.body import SIDES
from humanwalk.measures.events import CONTACT_ON_N, stretches
from humanwalk.measures.orientation import pelvis_rotation
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import GRAVITY
from humanwalk.walking.push import Push
from humanwalk.walking.walking_reference import Phase

WINDOW = 4.0
"""Events in this time before the body goes down count [s]: after a push it takes a few steps until a walker falls."""

GOING_DOWN = 0.85
"""Share of the pelvis' initial height above the lower sole below which the body is going down."""

MIN_PUSHED_SPEED = 0.1
"""Change of the body's speed by a push from which it counts as a cause [m/s]: 7 N s for 70 kg."""

SLIDING = 0.8
"""Share of the friction cone from which a foot may slide: simulated friction reaches its limit gradually."""

MIN_SLIP = 0.05
"""Distance that a sole slides in one go [m]; in sound walks it stays below 0.04 m."""

MIN_LEG_FORCE = 0.1
"""Force between the legs from which on it counts as a cause [body weights] (our choice)."""

MAX_DCM_ERROR = 0.3
"""Distance of the DCM from its reference at a touchdown, or in standing, from which balance is lost [m].

It is up to 0.05 m in undisturbed walking and up to 0.27 m after survived pushes of 60 N s; in falls it is above 0.5 m.
"""

FAILURES_IN_A_ROW = 4.0
"""QP failures in a row at which the controller has dropped its torques: four control periods of 6 ms are the first that
are longer than `whole_body.hold`, 20 ms."""

UNKNOWN = "unknown"


class FallReport(TypedDict):
    """Part of a summary: when the walker fell [s], its pelvis in W [m], the likely cause, and all in one line."""

    time_s: float
    x_m: float
    y_m: float
    cause: str
    description: str


@dataclass(frozen=True)
class Event:
    """What may have made a walker fall.

    Attributes:
        time: When it began [s].
        cause: Its kind, a key of `CAUSES`.
        text: One line about it.
    """

    time: float
    cause: str
    text: str


class Before(NamedTuple):
    """What is known of the time before the body goes down.

    Attributes:
        signals: The record of that time.
        mass: Body mass [kg].
        pushes: What pushed the walker, at any time.
    """

    signals: pa.Table
    mass: float
    pushes: Sequence[Push]


def report_fall(signals: pa.Table, mass: float, pushes: Sequence[Push]) -> FallReport:
    """When, where and likely why a record ends with a fall.

    Args:
        signals: The record.
        mass: Body mass [kg].
        pushes: What pushed the walker; samples of its force would miss or overrate a short push.
    """
    time, x, y = (float(signals[name][-1].as_py()) for name in (TIME, "pelvis.x_m", "pelvis.y_m"))
    events = events_before_fall(signals, mass, pushes)
    nothing = f"unknown; no {', '.join(CAUSES)} in the {WINDOW:g} s before"
    why = "; then ".join(event.text for event in events) or nothing
    cause = events[0].cause if events else UNKNOWN
    return {
        "time_s": time,
        "x_m": x,
        "y_m": y,
        "cause": cause,
        "description": f"fell at {time:.2f} s, pelvis at x {x:.2f} m, y {y:.2f} m; likely cause: {why}",
    }


def events_before_fall(signals: pa.Table, mass: float, pushes: Sequence[Push]) -> list[Event]:
    """The first event of every cause before the body goes down, in the order of their times; see `report_fall`."""
    before = Before(signals.filter(pa.array(_before_going_down(signals))), mass, pushes)
    recorded = set(signals.column_names)
    found = {cause: detect(before) for cause, (needed, detect) in CAUSES.items() if recorded.issuperset(needed)}
    events = [Event(at[0], cause, at[1]) for cause, at in found.items() if at is not None]
    return sorted(events, key=lambda event: event.time)


def _before_going_down(signals: pa.Table) -> Mask:
    """Rows in the `WINDOW` before the body goes down for the last time."""
    time = signals[TIME].to_numpy()
    soles = matrix(signals, [f"{side.lower()}_sole.z_m" for side in SIDES])
    height = signals["pelvis.z_m"].to_numpy() - soles.min(axis=1)
    up = np.flatnonzero(height >= GOING_DOWN * height[0])
    end = time[up[-1]] if up.size else time[-1]
    inside: Mask = (time >= end - WINDOW) & (time <= end)
    return inside


_Found = tuple[float, str] | None
"""Time of an event [s] and one line about it."""


def strongest_push(before: Before) -> _Found:
    """The push with the greatest impulse before the body goes down."""
    time = before.signals[TIME].to_numpy()
    acted = [(push, min(push.time + push.duration, time[-1]) - max(push.time, time[0])) for push in before.pushes]
    impulses = [(push.time, np.array(push.force[:2]) * duration) for push, duration in acted if duration > 0.0]
    began, impulse = max(impulses, key=lambda at: float(np.linalg.norm(at[1])), default=(0.0, np.zeros(2)))
    size = float(np.linalg.norm(impulse))
    if size < MIN_PUSHED_SPEED * before.mass:
        return None
    side = _side(-impulse, _heading(before.signals, int(np.searchsorted(time, began))))
    return began, f"pushed with about {size:.0f} N s from {side} at {began:.2f} s"


def first_slip(before: Before) -> _Found:
    """The first time that a loaded foot slides by `MIN_SLIP`."""
    signals, found = before.signals, []
    time = signals[TIME].to_numpy()
    for side in (side.lower() for side in SIDES):
        sole = matrix(signals, [f"{side}_sole.{axis}_m" for axis in "xy"])
        loaded = signals[f"{side}_foot.force_z_N"].to_numpy() > CONTACT_ON_N
        for first, end in stretches(loaded & (signals[f"{side}_foot.friction_use"].to_numpy() > SLIDING)):
            distance = float(np.linalg.norm(sole[end - 1] - sole[first]))
            if distance > MIN_SLIP:
                text = f"the {side} foot slid by {100.0 * distance:.0f} cm at {time[first]:.2f} s"
                found.append((float(time[first]), text))
    return min(found, default=None)


def first_touch_of_legs(before: Before) -> _Found:
    """The first time that the legs hit each other with `MIN_LEG_FORCE`."""
    time, force = (before.signals[name].to_numpy() for name in (TIME, "leg_contact.force_N"))
    rows = np.flatnonzero(force > MIN_LEG_FORCE * before.mass * GRAVITY)
    return (float(time[rows[0]]), f"the legs hit each other at {time[rows[0]]:.2f} s") if rows.size else None


def first_step_out_of_reach(before: Before) -> _Found:
    """The first touchdown that leaves the DCM farther than `MAX_DCM_ERROR` from its reference."""
    text = "the foot that landed at {time:.2f} s left the capture point (DCM) {error:.2f} m off its reference"
    return _far_dcm(before.signals, _touchdowns, text)


def balance_lost_standing(before: Before) -> _Found:
    """The first time in standing with a DCM farther than `MAX_DCM_ERROR` from its reference."""
    text = "in standing, the capture point (DCM) is {error:.2f} m off its reference at {time:.2f} s"
    return _far_dcm(before.signals, _standing, text)


def first_qp_failures(before: Before) -> _Found:
    """The first `FAILURES_IN_A_ROW` of the whole-body program."""
    time, in_a_row = (before.signals[name].to_numpy() for name in (TIME, "qp.failures_in_a_row"))
    rows = np.flatnonzero(in_a_row >= FAILURES_IN_A_ROW)
    return (float(time[rows[0]]), f"QP failures from {time[rows[0]]:.2f} s on") if rows.size else None


_DCM = (*(f"{point}.{axis}_m" for point in ("dcm", "dcm_reference") for axis in "xy"), "planner.phase")

CAUSES: dict[str, tuple[tuple[str, ...], Callable[[Before], _Found]]] = {
    "push": ((), strongest_push),
    "slip": (("right_foot.friction_use", "left_foot.friction_use"), first_slip),
    "legs that hit each other": (("leg_contact.force_N",), first_touch_of_legs),
    "foothold out of reach": (_DCM, first_step_out_of_reach),
    "balance lost in standing": (_DCM, balance_lost_standing),
    "QP failure": (("qp.failures_in_a_row",), first_qp_failures),
}
"""By cause: signals that not every record has, and a function that returns the event, or None."""


def _far_dcm(signals: pa.Table, rows_of: Callable[[Array], Mask], text: str) -> _Found:
    time = signals[TIME].to_numpy()
    error = np.linalg.norm(
        matrix(signals, ["dcm.x_m", "dcm.y_m"]) - matrix(signals, ["dcm_reference.x_m", "dcm_reference.y_m"]), axis=1
    )
    rows = np.flatnonzero(rows_of(signals["planner.phase"].to_numpy()) & (error > MAX_DCM_ERROR))
    return (float(time[rows[0]]), text.format(time=time[rows[0]], error=error[rows[0]])) if rows.size else None


def _touchdowns(phase: Array) -> Mask:
    """First rows of double support."""
    double = phase == Phase.DOUBLE_SUPPORT.value
    first: Mask = double & ~np.append(True, double[:-1])
    return first


def _standing(phase: Array) -> Mask:
    standing: Mask = (phase == Phase.STAND.value) | (phase == Phase.WEIGHT_SHIFT.value)
    return standing


def _heading(signals: pa.Table, row: int) -> float:
    """Angle about z of the pelvis' x axis in W [rad]."""
    ahead = pelvis_rotation(signals.slice(row, 1)).apply((1.0, 0.0, 0.0))[0]
    return math.atan2(ahead[1], ahead[0])


def _side(toward: Array, heading: float) -> str:
    """The side of the body that a horizontal direction points to."""
    bearing = math.atan2(toward[1], toward[0]) - heading
    return ("the front", "the left", "behind", "the right")[round(bearing / (0.5 * math.pi)) % 4]
