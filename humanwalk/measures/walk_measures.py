"""Single measures of a straight walk, each with its human range where a source is known.

`MEASURES` is the list: report, studies and tunings show what it holds.
"""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import pyarrow as pa

from humanwalk.body import SIDES, Side, human
from humanwalk.body.limbs import other_side
from humanwalk.gait.normative import CYCLE, SpeedGroup, dimensionless_speed, speed_group
from humanwalk.measures.center_of_pressure import backward_travels, cop_paths
from humanwalk.measures.curves import ANGLES, CURVES, over_strides
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
from humanwalk.measures.path import Directions, distance_along, path_directions
from humanwalk.measures.signals import TIME, UNITS
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.scenario import Scenario

TERMINAL_STANCE = (31.0, 50.0)
"""From heel rise to touchdown of the other foot [% of the gait cycle]: Perry and Burnfield (2010), chapter 2."""

PERRY = "Perry, Burnfield (2010), Gait Analysis"
ORENDURFF = "Orendurff et al. (2004), JRRD 41(6A) 829"
SCHWARTZ = "Schwartz et al. (2008)"
SCHULZ = "Schulz (2012), J. Neuroeng. Rehabil. 9:69"
KIRTLEY = "Kirtley, Whittle, Jefferson (1985), J. Biomed. Eng. 7(4) 282"

WALK_RATIOS = (0.64 / 117.0, 0.73 / 111.0)
"""Step length per cadence of women and of men at their own speed [m min]: Perry and Burnfield (2010).

The walk ratio does not depend on speed above 1.03 m/s, and is greater below: Murakami, Otaka (2017), J. Phys. Ther.
Sci. 29(4) 722.
"""
STANCE_SHARE = (0.642, -0.035, 0.02)
"""Stance share extrapolated to rest, change per m/s: Kirtley et al. (1985). Standard deviation between people: 1.9 to
2.5 % of the stride in the data at clinicalgaitanalysis.com/data/stance.html."""
STEP_WIDTH = (0.140, 0.031)
"""Mean and standard deviation at a free speed [leg lengths]: table 1 of Schulz (2012)."""

COM_EXCURSIONS = {
    "vertical": ((2.74e-2, 0.52e-2), (4.83e-2, 0.92e-2)),
    "lateral": ((6.99e-2, 1.34e-2), (3.85e-2, 1.41e-2)),
}
COM_SPEEDS = (0.7, 1.6)
"""Human mean and standard deviation at two speeds [m], and the speeds [m/s]; abstract of Orendurff et al. (2004)."""


@dataclass(frozen=True)
class Pace:
    """How fast a body walks: what human ranges depend on.

    Attributes:
        speed: mean speed of the strides [m/s].
        leg: leg length, the height of the hip joints in standing [m].
    """

    speed: float
    leg: float

    @property
    def dimensionless(self) -> float:
        """Speed over sqrt(g leg length)."""
        return dimensionless_speed(self.speed, self.leg)

    @property
    def group(self) -> SpeedGroup:
        """People who walk at this dimensionless speed."""
        return speed_group(self.dimensionless)


@dataclass(frozen=True)
class Walk:
    """The steady part of a straight walk.

    Attributes:
        signals: the record.
        scenario: what was simulated.
        feet: events of both feet from `begin` on.
        begin: time from which the walk is steady [s].
    """

    signals: pa.Table
    scenario: Scenario
    feet: Mapping[Side, FootEvents]
    begin: float

    @staticmethod
    def of(signals: pa.Table, scenario: Scenario) -> "Walk":
        """The part of a record from `Controller.steady_from` on."""
        begin = scenario.controller.steady_from(scenario.subject)
        return Walk(signals, scenario, {side: events_of(signals, side, begin) for side in SIDES}, begin)

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
        of = CURVES[curve].of
        return self.each(lambda side, foot: over_strides(foot, of(self.signals, side, self.mass)))


@dataclass(frozen=True)
class People:
    """Human range of a measure; for a mean with standard deviation, one standard deviation to either side."""

    low: float
    high: float
    source: str


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
        endings = {unit: f"_{ending}" for ending, unit in UNITS.items()}
        return re.sub(r"\W+", "_", self.name) + endings.get(self.unit, "")


def late_stance_knee(strides: Array) -> Array:
    """Least knee flexion in terminal stance [deg], from knee flexion over strides, (strides, 101) -> (strides,)."""
    begin, end = TERMINAL_STANCE
    least: Array = strides[:, (begin <= CYCLE) & (end >= CYCLE)].min(axis=1)
    return least


def com_excursions(signals: pa.Table, foot: FootEvents, axis: str) -> Array:
    """Range of the center of mass in every stride along y or z, measured from the straight line
    through the ends of the stride [m].
    """
    place = signals[f"com.{axis}_m"].to_numpy()
    return np.array([np.ptp(place[a : b + 1] - np.linspace(place[a], place[b], b + 1 - a)) for a, b in foot.strides])


def people_com_excursion(direction: str, pace: Pace) -> People | None:
    """Human range of the center of mass [m]; None outside of the two speeds of the source."""
    if not COM_SPEEDS[0] <= pace.speed <= COM_SPEEDS[1]:
        return None
    mean, sd = (float(np.interp(pace.speed, COM_SPEEDS, ends)) for ends in zip(*COM_EXCURSIONS[direction], strict=True))
    return People(mean - sd, mean + sd, f"{ORENDURFF}, at this speed")


def people_steps(pace: Pace) -> tuple[People, People]:
    """Human step length [m] and cadence [1/min].

    With the walk ratio r, the length is sqrt(60 r speed), and the cadence 60 speed / length. Dynamically similar bodies
    have walk ratios in proportion to the leg length to the power 1.5.
    """
    scale = (pace.leg / human().hip_height) ** 1.5
    low, high = (math.sqrt(60.0 * scale * ratio * pace.speed) for ratio in WALK_RATIOS)
    source = f"{PERRY}: walk ratio, from women's to men's, at this speed and leg length"
    return People(low, high, source), People(60.0 * pace.speed / high, 60.0 * pace.speed / low, source)


def people_stance(pace: Pace) -> People:
    """Human share of stance."""
    at_rest, slope, sd = STANCE_SHARE
    mean = at_rest + slope * pace.speed
    return People(mean - sd, mean + sd, f"{KIRTLEY}, at this speed")


def people_double_support(pace: Pace) -> People:
    """Human share of double support, of a symmetric gait."""
    stance = people_stance(pace)
    return People(2.0 * stance.low - 1.0, 2.0 * stance.high - 1.0, f"{KIRTLEY}: twice the stance minus the stride")


def people_step_width(pace: Pace) -> People:
    """Human step width [m]."""
    mean, sd = STEP_WIDTH
    return People((mean - sd) * pace.leg, (mean + sd) * pace.leg, SCHULZ)


def _late_stance_knee_of_people(pace: Pace) -> People:
    band = ANGLES["knee"].people(pace.group)
    low, high = late_stance_knee(np.array([band.mean - band.sd, band.mean + band.sd]))
    return People(float(low), float(high), SCHWARTZ)


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


def _peak_moment(joint: str, sense: str, sign: int) -> MeasureKind:
    """Greatest internal moment in every stride; the curves of MOMENTS are positive in extension and plantarflexion."""
    return MeasureKind(
        f"moment, {joint} {sense}", "N m/kg", lambda walk: (sign * walk.strides(f"{joint} moment")).max(axis=1)
    )


_AT_FREE_SPEED = f"{PERRY}, women and men at their own speed"

MEASURES: tuple[MeasureKind, ...] = (
    MeasureKind("speed", "m/s", lambda walk: walk.speeds, lambda pace: People(1.28, 1.43, _AT_FREE_SPEED)),
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
        _late_stance_knee_of_people,
    ),
    MeasureKind("cost of transport", "", _cost),
    _peak_moment("hip", "flexion", -1),
    _peak_moment("hip", "extension", 1),
    _peak_moment("knee", "flexion", -1),
    _peak_moment("knee", "extension", 1),
    _peak_moment("ankle", "dorsiflexion", -1),
    _peak_moment("ankle", "plantarflexion", 1),
)
"""Every measure, in the order of the report. CoP backward is from 10 to 55 % of the gait cycle, see `ROLL`."""
