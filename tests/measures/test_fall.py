"""When, where and why a walker fell, on constructed records and on a real fall."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from humanwalk.measures.fall import (
    CAUSES,
    FAILURES_IN_A_ROW,
    UNKNOWN,
    WINDOW,
    Event,
    FallReport,
    events_before_fall,
    report_fall,
)
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.walking.push import Push
from humanwalk.walking.walking_reference import Phase

MASS = 70.0
BEARINGS = {"the front": 0.0, "the left": 90.0, "behind": 180.0, "the right": -90.0}
PERIOD, END, DOWN = 0.01, 10.0, 9.5
"""Record of the falls below: the body goes down from DOWN on."""


def fallen(**changes: Any) -> pa.Table:
    """A walker that stands still, with both feet loaded, until it goes down; `changes` are functions of time."""
    time = PERIOD * np.arange(round(END / PERIOD) + 1)
    data = {"pelvis.z_m": 0.9 - np.clip(1.2 * (time - DOWN), 0.0, None), "pelvis.quaternion_w": np.ones_like(time)}
    data |= {f"pelvis.{name}": np.zeros_like(time) for name in ("x_m", "y_m", *(f"quaternion_{a}" for a in "xyz"))}
    for foot in ("right", "left"):
        data |= {f"{foot}_sole.{axis}_m": np.zeros_like(time) for axis in "xyz"}
        data |= {f"{foot}_foot.force_z_N": np.full_like(time, 350.0), f"{foot}_foot.friction_use": np.zeros_like(time)}
    data |= {f"{point}.{axis}_m": np.zeros_like(time) for point in ("dcm", "dcm_reference") for axis in "xy"}
    data |= {
        "planner.phase": np.full_like(time, Phase.SINGLE_SUPPORT.value),
        "qp.failures_in_a_row": np.zeros_like(time),
    }
    for name, value in changes.items():
        data[name] = np.broadcast_to(value(time), time.shape).astype(float)
    return pa.table({TIME: time, **data})


def report(pushes: Sequence[Push] = (), **changes: Any) -> FallReport:
    """The report of the fall of a pushed walker."""
    return report_fall(fallen(**changes), MASS, pushes)


def events(pushes: Sequence[Push] = (), **changes: Any) -> list[Event]:
    """The events before this fall."""
    return events_before_fall(fallen(**changes), MASS, pushes)


def constant(value: float) -> Any:
    return lambda time: np.full_like(time, value)


def during(begin: float, end: float, value: float) -> Any:
    return lambda time: np.where((time > begin - 1e-9) & (time < end - 1e-9), value, 0.0)


def slide(distance: float, begin: float = 8.0, duration: float = 0.2) -> Any:
    """A right foot that slides forward at the limit of friction."""
    return {
        "right_foot.friction_use": during(begin, begin + duration, 1.0),
        "right_sole.x_m": lambda time: distance * np.clip((time - begin) / (duration - PERIOD), 0.0, 1.0),
    }


def landing(time: Array) -> Array:
    """Phase of a walker whose foot lands at 8 s."""
    return np.where(time < 8.0 - 1e-9, Phase.SINGLE_SUPPORT.value, Phase.DOUBLE_SUPPORT.value)


EVENTS: dict[str, Any] = {
    "push": {"pushes": (Push(time=8.0, impulse=60.0, direction=-0.5 * np.pi),)},
    "slip": slide(0.2),
    "legs that hit each other": {"leg_contact.force_N": during(8.0, 8.1, 300.0)},
    "foothold out of reach": {"planner.phase": landing, "dcm.x_m": during(7.0, END, 0.5)},
    "balance lost in standing": {
        "planner.phase": constant(Phase.STAND.value),
        "dcm.x_m": during(8.0, END, 0.5),
    },
    "QP failure": {"qp.failures_in_a_row": during(8.0, 8.2, FAILURES_IN_A_ROW)},
}


def test_every_cause_has_a_constructed_record() -> None:
    assert EVENTS.keys() == CAUSES.keys()


@pytest.mark.parametrize("cause", EVENTS)
def test_the_event_before_a_fall_is_its_likely_cause(cause: str) -> None:
    found = report(**EVENTS[cause])
    assert found["cause"] == cause
    (event,) = events(**EVENTS[cause])
    assert event.time == pytest.approx(8.0)
    assert event.text in found["description"]
    assert "8.00 s" in event.text


def test_a_fall_without_an_event_has_no_known_cause() -> None:
    away: dict[str, Any] = {"pelvis.x_m": lambda time: time, "pelvis.y_m": lambda time: -time}
    found = report(**away)
    assert (found["cause"], found["time_s"]) == (UNKNOWN, END)
    assert (found["x_m"], found["y_m"]) == (END, -END)
    assert found["description"].startswith(
        "fell at 10.00 s, pelvis at x 10.00 m, y -10.00 m; likely cause: unknown; no"
    )


def test_the_first_event_is_the_cause_and_the_others_follow() -> None:
    both = {**EVENTS["push"], **slide(0.2, begin=8.5), "qp.failures_in_a_row": during(8.8, 9.0, FAILURES_IN_A_ROW)}
    assert [event.cause for event in events(**both)] == ["push", "slip", "QP failure"]
    assert report(**both)["cause"] == "push"
    assert report(**both)["description"].count("; then ") == 2


def test_what_happens_while_the_body_goes_down_or_long_before_does_not_count() -> None:
    for time in (DOWN + 0.2, DOWN - WINDOW - 1.0):
        assert report([Push(time=time, impulse=90.0)])["cause"] == UNKNOWN


@pytest.mark.parametrize(
    "harmless",
    [
        {"pushes": (Push(time=8.0, impulse=5.0),)},
        slide(0.03),
        {**slide(0.2), "right_foot.force_z_N": during(8.0, 8.2, 10.0)},
        {**slide(0.2), "right_foot.friction_use": during(8.0, 8.2, 0.5)},
        {"planner.phase": landing, "dcm.x_m": during(7.0, END, 0.2)},
        {"leg_contact.force_N": during(8.0, 8.1, 20.0)},
        {"dcm.x_m": during(8.0, 8.3, 0.5)},
        {"qp.failures_in_a_row": during(8.0, 8.2, 1.0)},
    ],
    ids=[
        "weak push",
        "short slip",
        "unloaded foot",
        "rolling foot",
        "foothold near",
        "legs that brush",
        "recovered in swing",
        "one failure",
    ],
)
def test_events_that_walkers_survive_do_not_count(harmless: Any) -> None:
    assert events(**harmless) == []


@given(st.floats(-180.0, 180.0), st.sampled_from(tuple(BEARINGS)), st.floats(-40.0, 40.0))
def test_the_side_of_a_push_is_that_of_the_body(heading: float, side: str, off: float) -> None:
    away = np.radians(heading + BEARINGS[side] + off + 180.0)
    w, x, y, z = Rotation.from_euler("z", heading, degrees=True).as_quat(scalar_first=True)
    changes = {f"pelvis.quaternion_{axis}": constant(value) for axis, value in (("w", w), ("x", x), ("y", y), ("z", z))}
    push = Push(time=8.0, impulse=60.0, direction=away)
    assert f"pushed with about 60 N s from {side} at 8.00 s" in report([push], **changes)["description"]


def test_the_strongest_push_is_named() -> None:
    pushes = Push(time=7.0, impulse=30.0), Push(time=8.0, impulse=90.0)
    assert "pushed with about 90 N s from behind at 8.00 s" in report(pushes)["description"]


@given(begin=st.floats(6.0, 9.0), duration=st.floats(0.001, 0.5))
def test_a_push_has_its_own_impulse_however_short(begin: float, duration: float) -> None:
    push = Push(time=begin, duration=duration, impulse=30.0, direction=0.0)
    said = f"pushed with about 30 N s from behind at {begin:.2f} s"
    assert said in report([push, replace(push, time=begin - 0.5, impulse=20.0)])["description"]


def test_a_push_counts_as_far_as_it_acted_before_the_body_went_down() -> None:
    # The pelvis is at GOING_DOWN of its height 0.11 s after DOWN.
    long = Push(time=DOWN - 0.89, duration=10.0, impulse=1000.0, direction=0.5 * np.pi)
    assert "pushed with about 100 N s from the right" in report([long])["description"]
    away = (Push(time=DOWN + 0.2), Push(time=DOWN - WINDOW - 1.0), Push(time=8.0, impulse=5.0))
    assert report(away)["cause"] == UNKNOWN


def test_a_walker_without_planner_has_no_events_of_it() -> None:
    signals = fallen()
    own = [name for name in signals.column_names if not name.startswith(("dcm", "planner", "qp"))]
    assert report_fall(signals.select(own), MASS, EVENTS["push"]["pushes"])["cause"] == "push"


def test_a_real_walker_that_is_knocked_over() -> None:
    overrides = {"pushes.given": "[{time: 0.2, impulse: 200, direction: -1.5708}]", "duration": "3"}
    outcome = simulate(load_scenario("stand", overrides))
    fall = outcome.summary()["fall"]
    assert outcome.end == "fell"
    assert fall is not None
    assert fall["cause"] == "push"
    assert " from the left at 0.20 s; then the foot that landed at " in fall["description"]
    assert fall["time_s"] == pytest.approx(outcome.signals[TIME][-1].as_py())
    # The push is to the right.
    assert fall["y_m"] < -0.2


@pytest.mark.parametrize("time", [0.2, 0.203])
def test_a_push_shorter_than_a_sampling_period_is_the_cause_with_its_impulse(time: float) -> None:
    push = f"[{{time: {time}, impulse: 200, direction: -1.5708, duration: 0.002}}]"
    fall = simulate(load_scenario("stand", {"pushes.given": push, "duration": "3"})).summary()["fall"]
    assert fall is not None
    assert "likely cause: pushed with about 200 N s from the left at 0.20 s; " in fall["description"]
