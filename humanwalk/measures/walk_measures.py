"""Single measures of a straight walk, each with its human range where a source is known.

`MEASURES` is the list: report, studies and tunings show what it holds.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import pyarrow as pa

from humanwalk.body import SIDES, Side
from humanwalk.measures.center_of_pressure import backward_travels, cop_paths
from humanwalk.measures.curves import CURVES, late_stance_knee, over_strides
from humanwalk.measures.effort import cost_of_transport
from humanwalk.measures.events import FootEvents, events_of
from humanwalk.measures.gait_measures import (
    cadence,
    double_support_shares,
    stance_shares,
    step_lengths,
    step_widths,
    stride_lengths,
    stride_times,
)
from humanwalk.measures.ground_force import contact_lost, force_peaks, peak_counts, vertical_force
from humanwalk.measures.human_ranges import (
    PERRY,
    Pace,
    People,
    people_com_excursion,
    people_double_support,
    people_late_stance_knee,
    people_speed,
    people_stance,
    people_step_width,
    people_steps,
)
from humanwalk.measures.path import Directions, distance_along, path_directions
from humanwalk.measures.signals import ENDINGS, TIME
from humanwalk.measures.steady import steady_rows
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.scenario import Scenario
from humanwalk.sides import other_side

MOMENT_PEAKS = (
    ("hip", "flexion", -1.0),
    ("hip", "extension", 1.0),
    ("knee", "flexion", -1.0),
    ("knee", "extension", 1.0),
    ("ankle", "dorsiflexion", -1.0),
    ("ankle", "plantarflexion", 1.0),
)
"""Peaks of the internal moments: joint, direction of the moment, and its sign in the curves of MOMENTS."""


@dataclass(frozen=True)
class Walk:
    """The steady part of a straight walk.

    Attributes:
        signals: the record.
        scenario: what was simulated.
        feet: events of both feet in the steady part.
        begin: time from which the walk is steady [s].
    """

    signals: pa.Table
    scenario: Scenario
    feet: Mapping[Side, FootEvents]
    begin: float

    @staticmethod
    def of(signals: pa.Table, scenario: Scenario) -> "Walk":
        """The steady part of a record; see `steady_rows`."""
        counted = steady_rows(signals, scenario)
        feet = {side: events_of(signals, side, counted) for side in SIDES}
        return Walk(signals, scenario, feet, scenario.controller.steady_from(scenario.subject))

    @property
    def mass(self) -> float:
        """Body mass [kg]."""
        return self.scenario.subject.mass

    @cached_property
    def directions(self) -> Directions:
        """Directions of the commanded path at every row."""
        return path_directions(self.signals, self.scenario.controller.command)

    @property
    def facing(self) -> Array:
        """Heading of the commanded path at every row, see `Directions`."""
        return self.directions.facing

    @cached_property
    def speeds(self) -> Array:
        """Speed of every stride [m/s]."""
        return self.each(lambda side, foot: stride_lengths(self.signals, side, foot, self.facing) / stride_times(foot))

    @cached_property
    def pace(self) -> Pace:
        """Mean speed of the strides, and the leg length."""
        return Pace(float(self.speeds.mean()), self.scenario.subject.skeleton.hip_height)

    @cached_property
    def forces(self) -> dict[Side, Array]:
        """Vertical force on each foot without impacts [body weights], shape (rows,)."""
        return {side: vertical_force(self.signals, side, self.mass * GRAVITY) for side in SIDES}

    def each(self, measure: Callable[[Side, FootEvents], Array]) -> Array:
        """A measure of the steps, strides or stances of both legs."""
        return np.concatenate([measure(side, foot) for side, foot in self.feet.items()])

    def strides(self, curve: str) -> Array:
        """One of CURVES over the strides of both legs, shape (strides, 101)."""
        return self.each(lambda side, foot: self.strides_of(curve, side))

    def strides_of(self, curve: str, side: Side) -> Array:
        """One of CURVES over the strides of a leg, shape (strides, 101)."""
        return over_strides(self.feet[side], CURVES[curve].of(self.signals, side, self.mass, self.facing))


@dataclass(frozen=True)
class Measure:
    """A measure of a walk with its human range.

    Attributes:
        name: of the measure.
        unit: "" for a pure number, BW for body weights.
        values: one per step, stride or stance of both legs, or one for the whole walk.
        worst: whether the greatest value counts, not the mean.
        people: the human range, None where no source is known.
    """

    name: str
    unit: str
    values: Array
    worst: bool = False
    people: People | None = None

    @property
    def value(self) -> float:
        """Mean of the values, or the greatest one; NaN without values."""
        values = self.values[np.isfinite(self.values)]
        return float((values.max if self.worst else values.mean)()) if values.size else np.nan


@dataclass(frozen=True)
class MeasureKind:
    """Definition of a measure: see `Measure`."""

    name: str
    unit: str
    of: Callable[[Walk], Array]
    people: Callable[[Pace], People | None] = lambda pace: None
    worst: bool = False

    def of_walk(self, walk: Walk) -> Measure:
        """The measure of a walk."""
        return Measure(self.name, self.unit, self.of(walk), self.worst, self.people(walk.pace))

    @property
    def column(self) -> str:
        """Name in tables, with the unit: CoP_backward_m."""
        ending = f"_{ENDINGS[self.unit]}" if self.unit in ENDINGS else ""
        return re.sub(r"\W+", "_", self.name) + ending


def com_excursions(signals: pa.Table, foot: FootEvents, axis: str) -> Array:
    """Range of the center of mass in every stride along y or z, measured from the straight line
    through the ends of the stride [m].
    """
    place = signals[f"com.{axis}_m"].to_numpy()
    return np.array([np.ptp(place[a : b + 1] - np.linspace(place[a], place[b], b + 1 - a)) for a, b in foot.strides])


def _of_perry(value: float) -> Callable[[Pace], People]:
    return lambda pace: People(value, value, PERRY)


def _cadence(walk: Walk) -> Array:
    return np.array([cadence(walk.feet)], dtype=float)


def _cost(walk: Walk) -> Array:
    steady = walk.signals[TIME].to_numpy() >= walk.begin
    distance = distance_along(walk.signals, steady, walk.directions.travel)
    cost = cost_of_transport(walk.signals, steady, walk.mass, distance)
    return np.array([cost], dtype=float)


def _cop_backward(walk: Walk) -> Array:
    return walk.each(lambda side, foot: backward_travels(cop_paths(walk.signals, side, foot)))


def _two_peaks(walk: Walk) -> Array:
    return np.array([walk.each(lambda side, foot: peak_counts(walk.forces[side], foot) == 2).mean()])


def _force_peak(column: int, walk: Walk) -> Array:
    return walk.each(lambda side, foot: force_peaks(walk.forces[side], foot)[:, column])


def _com_range(direction: str, axis: str) -> MeasureKind:
    return MeasureKind(
        f"center of mass, {direction} range",
        "m",
        lambda walk: walk.each(lambda side, foot: com_excursions(walk.signals, foot, axis)),
        partial(people_com_excursion, direction),
    )


def _peak_moment(joint: str, sense: str, sign: float) -> MeasureKind:
    """Greatest internal moment in every stride; see `MOMENT_PEAKS`."""
    return MeasureKind(
        f"moment, {joint} {sense}", "N m/kg", lambda walk: (sign * walk.strides(f"{joint} moment")).max(axis=1)
    )


MEASURES: tuple[MeasureKind, ...] = (
    MeasureKind("speed", "m/s", lambda walk: walk.speeds, people_speed),
    MeasureKind(
        "step length",
        "m",
        lambda walk: walk.each(lambda side, foot: step_lengths(walk.signals, side, foot, walk.facing)),
        lambda pace: people_steps(pace)[0],
    ),
    MeasureKind("cadence", "1/min", _cadence, lambda pace: people_steps(pace)[1]),
    MeasureKind(
        "share of stance",
        "",
        lambda walk: walk.each(lambda side, foot: stance_shares(foot)),
        people_stance,
    ),
    MeasureKind(
        "share of double support",
        "",
        lambda walk: walk.each(lambda side, foot: double_support_shares(foot, walk.feet[other_side(side)])),
        people_double_support,
    ),
    MeasureKind(
        "step width",
        "m",
        lambda walk: walk.each(lambda side, foot: step_widths(walk.signals, side, foot, walk.facing)),
        people_step_width,
    ),
    _com_range("vertical", "z"),
    _com_range("lateral", "y"),
    *(
        MeasureKind(f"vertical GRF, {name}", "BW", partial(_force_peak, column), _of_perry(share))
        for column, (name, share) in enumerate({"first peak": 1.1, "dip": 0.8, "second peak": 1.1}.items())
    ),
    MeasureKind("share of stances with two peaks", "", _two_peaks, _of_perry(1.0)),
    MeasureKind(
        "contact lost after heel strike",
        "s",
        lambda walk: walk.each(lambda side, foot: contact_lost(walk.signals, side, foot)),
        _of_perry(0.0),
        worst=True,
    ),
    MeasureKind("CoP backward", "m", _cop_backward, worst=True),
    MeasureKind(
        "least knee flexion, terminal stance",
        "deg",
        lambda walk: late_stance_knee(walk.strides("knee")),
        people_late_stance_knee,
    ),
    MeasureKind("cost of transport", "", _cost),
    *(_peak_moment(joint, sense, sign) for joint, sense, sign in MOMENT_PEAKS),
)
"""Every measure, in the order of the report. CoP backward is from 10 to 55 % of the gait cycle, see `ROLL`."""
