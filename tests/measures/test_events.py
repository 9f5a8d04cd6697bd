"""Touchdown and toe-off of constructed vertical forces whose stances are known."""

from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from humanwalk.measures.events import (
    CONTACT_OFF_N,
    CONTACT_ON_N,
    MIN_STANCE_S,
    MIN_SWING_S,
    WHOLE_SWING_S,
    FootEvents,
    events_of,
    foot_events,
)
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Array

PERIOD = 0.002
WEIGHT = 700.0
STANCES = ((0.5, 1.1), (1.5, 2.1), (2.5, 3.1))
"""Begin and end of the stances of the constructed walk [s]."""


def rows(seconds: float) -> int:
    return round(seconds / PERIOD)


def force_of(*stances: tuple[float, float], duration: float = 3.5, force: float = WEIGHT) -> Array:
    """A foot that carries a force within some intervals [s]."""
    values = np.zeros(rows(duration) + 1)
    for begin, end in stances:
        values[rows(begin) : rows(end)] = force
    return values


def lift(force: Array, *intervals: tuple[float, float]) -> Array:
    """The same without contact within some intervals [s]."""
    force = force.copy()
    for begin, end in intervals:
        force[rows(begin) : rows(end)] = 0.0
    return force


def events_in(force: Any) -> FootEvents:
    return foot_events(PERIOD * np.arange(force.size), force)


def found(force: Any) -> Any:
    """Touchdown and toe-off times [s]."""
    events = events_in(force)
    return events.time[events.touchdowns], events.time[events.toe_offs]


def assert_events(force: Array, stances: tuple[tuple[float, float], ...] = STANCES) -> None:
    touchdowns, toe_offs = found(force)
    np.testing.assert_allclose(touchdowns, [begin for begin, _ in stances], atol=1e-9)
    np.testing.assert_allclose(toe_offs, [end for _, end in stances], atol=1e-9)


def test_events_are_the_ends_of_the_stances() -> None:
    assert_events(force_of(*STANCES))


def test_contact_is_true_from_touchdown_to_toe_off() -> None:
    time = PERIOD * np.arange(rows(3.5) + 1)
    events = foot_events(time, lift(force_of(*STANCES), (0.52, 0.55)))  # type: ignore[arg-type]
    expected = np.zeros(time.size, dtype=bool)
    for down, up in zip(events.touchdowns, events.toe_offs, strict=True):
        expected[down:up] = True
    np.testing.assert_array_equal(events.contact, expected)
    assert events.stances == list(zip(events.touchdowns, events.toe_offs, strict=True))
    np.testing.assert_allclose(events.touchdown_times, [0.5, 1.5, 2.5])


# Bounces, drags and scuffs.


def test_heel_that_bounces_once_lands_at_its_first_contact() -> None:
    """The heel of `walk` at 1.0 m/s: 25 ms of contact, 24 ms of flight."""
    assert_events(lift(force_of(*STANCES), (0.525, 0.549), (1.525, 1.549), (2.525, 2.549)))


def test_heel_that_bounces_several_times_lands_at_its_first_contact() -> None:
    assert_events(lift(force_of(*STANCES), (1.504, 1.56), (1.564, 1.63), (1.636, 1.66)))


def test_touch_of_one_sample_that_begins_a_stance_is_the_touchdown() -> None:
    assert_events(lift(force_of(*STANCES), (1.502, 1.502 + MIN_SWING_S - PERIOD)))


def test_toe_that_drags_leaves_the_ground_at_its_last_contact() -> None:
    assert_events(lift(force_of(*STANCES), (1.0, 1.04), (1.05, 1.09)))


def test_foot_that_brushes_the_ground_in_mid_swing_stays_in_swing() -> None:
    assert_events(force_of(*STANCES, (1.28, 1.28 + MIN_STANCE_S - PERIOD)))


def test_stance_as_short_as_a_sprinter_s_counts() -> None:
    stances = ((0.5, 0.6), (1.0, 1.1))
    assert_events(force_of(*stances), stances)


def test_swing_just_as_long_as_the_shortest_counts() -> None:
    stances = ((0.5, 1.0), (1.0 + MIN_SWING_S + PERIOD, 2.0))
    assert_events(force_of(*stances), stances)


@given(
    contact=st.integers(1, 100),
    flight=st.integers(1, rows(MIN_SWING_S) - 1),
    stance=st.sampled_from(range(len(STANCES))),
    again=st.integers(0, 3),
)
def test_bounces_after_a_touchdown_change_no_event(contact: int, flight: int, stance: int, again: int) -> None:
    begin, end = (rows(at) for at in STANCES[stance])
    force = force_of(*STANCES)
    first = begin + contact
    for _ in range(again + 1):
        assume(first + flight < end)
        force[first : first + flight] = 0.0
        first += flight + contact
    assert_events(force)


@given(
    st.lists(
        st.tuples(st.integers(1, 120), st.sampled_from([0.0, 35.0, 500.0, -10.0, np.nan])), min_size=1, max_size=20
    )
)
def test_of_any_force_no_swing_or_whole_stance_is_short_and_events_alternate(pieces: list[tuple[int, float]]) -> None:
    force = np.concatenate([np.full(length, level) for length, level in pieces])
    time = PERIOD * np.arange(force.size)
    events = foot_events(time, force)  # type: ignore[arg-type]
    down, up = events.touchdowns, events.toe_offs
    assert abs(down.size - up.size) <= 1
    if down.size and up.size:
        later = min(down.size, up.size)
        first, second = (down, up) if down[0] < up[0] else (up, down)
        assert (first[:later] < second[:later]).all()
        assert (second[: first.size - 1] < first[1:]).all()
    assert all(time[b] - time[a] >= MIN_STANCE_S - 1e-9 for a, b in events.stances)
    swings = [(a, down[down > a][0]) for a in up if (down > a).any()]
    assert all(time[b] - time[a] >= MIN_SWING_S - 1e-9 for a, b in swings)


# Ends of the record.


@pytest.mark.parametrize("unloaded", [0.0, 0.002, 0.05])
def test_standing_start_is_no_touchdown(unloaded: float) -> None:
    """The first rows of a body that starts standing are without force."""
    touchdowns, toe_offs = found(force_of((unloaded, 1.0), (1.4, 2.0)))
    np.testing.assert_allclose(touchdowns, [1.4])
    np.testing.assert_allclose(toe_offs, [1.0, 2.0])


def test_start_in_the_air_is_followed_by_a_touchdown() -> None:
    touchdowns, _ = found(force_of((0.3, 3.5)))
    np.testing.assert_allclose(touchdowns, [0.3])


def test_stance_that_the_record_cuts_off_has_no_toe_off() -> None:
    touchdowns, toe_offs = found(force_of((0.5, 1.1), (3.48, 4.0)))
    np.testing.assert_allclose(touchdowns, [0.5, 3.48])
    np.testing.assert_allclose(toe_offs, [1.1])


@pytest.mark.parametrize(
    ("swing", "contact", "count"),
    [
        (0.15, 0.5 * MIN_STANCE_S, 0),
        (0.15, 1.5 * MIN_STANCE_S, 1),
        (WHOLE_SWING_S + PERIOD, 0.5 * MIN_STANCE_S, 1),
    ],
    ids=["toes that scuff", "as long as a stance", "after a whole swing"],
)
def test_contact_that_the_record_cuts_off_is_a_touchdown_if_it_cannot_be_a_scuff(
    swing: float, contact: float, count: int
) -> None:
    down = 3.5 - contact
    assert found(force_of((down - swing - 0.6, down - swing), (down, 4.0)))[0].size == 1 + count


@given(
    st.lists(st.tuples(st.integers(1, 120), st.integers(1, 60)), min_size=2, max_size=6),
    st.floats(0.0, 0.9),
)
def test_part_of_a_record_has_events_of_the_whole_record_only(pieces: list[tuple[int, int]], begin: float) -> None:
    force = np.concatenate([np.repeat((0.0, WEIGHT), lengths) for lengths in pieces])
    whole, first = events_in(force), int(begin * force.size)
    for last in range(first + 1, force.size, 5):
        part = events_in(force[first:last])
        known = part.touchdowns.tolist()
        # Contact as the record ends, a whole swing after the last stance, may be a scuff all the same.
        is_late = bool(known) and last - first - known[-1] < rows(MIN_STANCE_S)
        if is_late and not part.contact[max(known[-1] - rows(WHOLE_SWING_S) + 1, 0) : known[-1]].any():
            known.pop()
        assert {row + first for row in known} <= set(whole.touchdowns)
        assert set(part.toe_offs + first) <= set(whole.toe_offs)


def test_loss_of_contact_that_the_record_cuts_off_is_no_toe_off_before_it_is_as_long_as_a_swing() -> None:
    for rest, count in ((0.05, 0), (0.15, 1)):
        assert found(force_of((0.5, 3.5 - rest)))[1].size == count


@pytest.mark.parametrize("force", [0.0, WEIGHT, np.nan])
@pytest.mark.parametrize("size", [1, 2, 500])
def test_force_that_never_changes_has_no_events(force: Any, size: Any) -> None:
    events = foot_events(PERIOD * np.arange(size), np.full(size, force))
    assert events.touchdowns.size == events.toe_offs.size == 0
    assert set(events.contact.tolist()) == {force == WEIGHT}


def test_fall_leaves_the_events_before_it() -> None:
    """The feet leave the ground and knock against it, then lie."""
    fallen = lift(force_of((0.5, 1.1), (1.5, 1.9), (2.2, 2.23), (2.34, 2.36), (3.0, 3.4)))
    touchdowns, toe_offs = found(fallen)
    np.testing.assert_allclose(touchdowns, [0.5, 1.5, 3.0])
    np.testing.assert_allclose(toe_offs, [1.1, 1.9, 3.4])


# Thresholds.


def test_force_between_the_thresholds_changes_no_contact() -> None:
    between = 0.5 * (CONTACT_ON_N + CONTACT_OFF_N)
    levels = np.repeat([0.0, between, 500.0, between, 0.0, between], 100)
    contact = foot_events(PERIOD * np.arange(levels.size), levels).contact  # type: ignore[arg-type]
    assert contact[::100].tolist() == [False, False, True, True, False, False]


@given(seed=st.integers(0, 2**32 - 1), amplitude=st.floats(0.0, CONTACT_OFF_N - 1.0))
def test_noise_below_the_hysteresis_changes_no_event(seed: int, amplitude: float) -> None:
    noise = amplitude * np.random.default_rng(seed).uniform(-1, 1, rows(3.5) + 1)
    assert_events(force_of(*STANCES) + noise)


@given(seed=st.integers(0, 2**32 - 1))
def test_noise_around_the_thresholds_moves_events_along_the_slope_of_the_force_only(seed: int) -> None:
    """A force that rises and falls within 20 ms, with noise of 15 N."""
    ramp = np.ones(rows(0.02)) / rows(0.02)
    force = np.convolve(force_of(*STANCES), ramp)[: rows(3.5) + 1]
    noise = np.random.default_rng(seed).uniform(-15.0, 15.0, force.size)
    touchdowns, toe_offs = found(force + noise)
    np.testing.assert_allclose(touchdowns, [begin for begin, _ in STANCES], atol=0.02)
    np.testing.assert_allclose(toe_offs, [end for _, end in STANCES], atol=0.022)


# Of a record.


def test_events_of_a_record_are_those_of_the_rows_that_count() -> None:
    force = force_of(*STANCES)
    time = PERIOD * np.arange(force.size)
    signals = pa.table({TIME: time, "left_foot.force_z_N": force})
    late = events_of(signals, "Left", time >= 0.8)
    np.testing.assert_allclose(late.touchdown_times, [1.5, 2.5])
    assert len(late.strides) == 1
    assert late.contact.sum() == events_of(signals, "Left").contact.sum()


def test_a_stride_or_stance_with_a_row_that_does_not_count_is_left_out() -> None:
    force = force_of(*STANCES)
    time = PERIOD * np.arange(force.size)
    whole = foot_events(time, force)  # type: ignore[arg-type]
    for (a, b), row in ((whole.strides[1], whole.strides[1][0] + 1), (whole.strides[0], whole.strides[0][1] - 1)):
        events = foot_events(time, force, np.arange(time.size) != row)  # type: ignore[arg-type]
        assert events.strides == [stride for stride in whole.strides if stride != (a, b)]
        assert events.stances == [(down, off) for down, off in whole.stances if not down <= row < off]
