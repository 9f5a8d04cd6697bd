"""Comparison with human gait, stride by stride: angles over the gait cycle, measures of steps, forces and effort.

People's angles are those of Schwartz, Rozumalski, Trost (2008), "The effect of walking speed on the gait of typically
developing children", J. Biomech. 41(8) 1639-1650, at self-selected speed. Other measures have
human values where a source is known.
"""

import csv
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from importlib.resources import files
from operator import attrgetter

import numpy as np
import pyarrow as pa
from scipy.signal import butter, find_peaks, sosfiltfilt
from scipy.spatial.transform import Rotation

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import LEGS, Leg, other_side
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
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array, Indices
from humanwalk.quantity import GRAVITY, ParameterError
from humanwalk.scenario import Scenario

CYCLE = np.linspace(0.0, 100.0, 101)
"""Points of the gait cycle at which curves are compared [%]."""

TERMINAL_STANCE = (31.0, 50.0)
"""From heel rise to touchdown of the other foot [% of the gait cycle]: Perry and Burnfield (2010), chapter 2."""

FORCE_CUTOFF_HZ = 15.0
"""The ground force of walking has 99 % of its power below: Antonsson and Mann (1985), J. Biomech. 18(1) 39-47."""

MIN_VALLEY = 0.05
"""Smallest depth of a valley beside a peak of the vertical force [body weights]."""

MIN_STRIDES = 2
MAX_HEADING = np.radians(20.0)
"""Strides of each leg that a comparison needs, and their largest angle from straight ahead [rad]."""

PEOPLE_DATA = "models/normative_gait/schwartz2008_free_angles.csv"
PERRY = "Perry, Burnfield (2010), Gait Analysis"
ORENDURFF = "Orendurff et al. (2004), JRRD 41(6A) 829"
DONELAN = "Donelan, Kram, Kuo (2001), Proc. R. Soc. B 268:1985"
SCHWARTZ = "Schwartz et al. (2008)"

PREFERRED_STEP_WIDTH = 0.13
"""Human, per leg length; abstract of Donelan, Kram, Kuo (2001)."""

COM_EXCURSIONS = {
    "vertical": ((2.74e-2, 0.52e-2), (4.83e-2, 0.92e-2)),
    "lateral": ((6.99e-2, 1.34e-2), (3.85e-2, 1.41e-2)),
}
COM_SPEEDS = (0.7, 1.6)
"""Human mean and standard deviation at two speeds [m], and the speeds [m/s]; abstract of Orendurff et al. (2004)."""


JOINTS: dict[str, Callable[[Leg], str]] = {
    "hip": attrgetter("hip_flexion"),
    "knee": attrgetter("knee"),
    "ankle": attrgetter("ankle"),
}
"""The sagittal joint of a leg by its name in ANGLES."""


def joint_signal(signals: pa.Table, joint: str, side: Side, quantity: str) -> Array:
    """A signal of one of JOINTS, shape (rows,): its angle_rad, velocity_rad_s or torque_N_m."""
    values: Array = signals[f"{JOINTS[joint](LEGS[side])}.{quantity}"].to_numpy()
    return values


def _joint(joint: str, signals: pa.Table, side: Side) -> Array:
    return np.degrees(joint_signal(signals, joint, side, "angle_rad"))


def _pelvis(axis: int, left: int, right: int, signals: pa.Table, side: Side) -> Array:
    quaternions = matrix(signals, [f"pelvis.quaternion_{part}" for part in "xyzw"])
    angles: Array = Rotation.from_quat(quaternions).as_euler("ZXY")[:, axis]
    return np.degrees(angles * (left if side == "Left" else right))


@dataclass(frozen=True)
class Angle:
    """An angle that is compared with people's.

    Attributes:
        positive: its positive sense.
        people: the quantity of the human data.
        of: the angle of a record relative to one leg [deg], shape (rows,).
    """

    positive: str
    people: str
    of: Callable[[pa.Table, Side], Array]


ANGLES = {
    "hip": Angle("flexion", "hip_flexion_deg", partial(_joint, "hip")),
    "knee": Angle("flexion", "knee_flexion_deg", partial(_joint, "knee")),
    "ankle": Angle("dorsiflexion", "ankle_dorsiflexion_deg", partial(_joint, "ankle")),
    "pelvis tilt": Angle("forward", "pelvis_anterior_tilt_deg", partial(_pelvis, 2, 1, 1)),
    "pelvis obliquity": Angle("side up", "pelvis_up_obliquity_deg", partial(_pelvis, 1, 1, -1)),
    "pelvis rotation": Angle("side forward", "pelvis_internal_rotation_deg", partial(_pelvis, 0, -1, 1)),
}
"""Every angle by name. The pelvis turns by rotation, obliquity, tilt in this order: Baker (2001), Gait Posture 13:1-6.

Tilt, and with it hip flexion, has another zero: the human pelvic plane tilts some 10 degrees forward in upright
standing, where this model's pelvis is level. `Likeness.difference` contains this offset, `Likeness.correlation` not.
"""


@cache
def people(quantity: str) -> tuple[Array, Array, Array]:
    """Gait cycle [%], mean and standard deviation [deg] of an angle of able-bodied people: see PEOPLE_DATA."""
    text = files("humanwalk").joinpath(PEOPLE_DATA).read_text(encoding="utf-8")
    rows = [row for row in csv.DictReader(text.splitlines()) if row["quantity"] == quantity]
    cycle, mean, sd = (np.array([float(row[key]) for row in rows]) for key in ("gait_cycle_percent", "mean", "sd"))
    return cycle, mean, sd


def over_strides(foot: FootEvents, values: Array) -> Array:
    """A signal over every whole stride of a leg at the points of CYCLE, shape (strides, 101)."""
    time = foot.time
    strides = [np.interp(time[a] + CYCLE / 100.0 * (time[b] - time[a]), time, values) for a, b in foot.strides]
    return np.array(strides).reshape(-1, CYCLE.size)


@dataclass(frozen=True)
class Likeness:
    """Agreement of an angle with the human mean curve, one number per stride, shape (strides,).

    Attributes:
        correlation: Pearson's, over the cycle; NaN where the angle is constant.
        difference: mean of the angle minus the human mean [deg].
        rms: root mean square of the angle minus the human mean [deg].
        inside: share of the cycle within one standard deviation of the human mean.
    """

    correlation: Array
    difference: Array
    rms: Array
    inside: Array

    @staticmethod
    def of(strides: Array, quantity: str) -> "Likeness":
        """Of an angle over strides [deg], shape (strides, 101), and a quantity of people's data."""
        cycle, mean, sd = people(quantity)
        mean, sd = np.interp(CYCLE, cycle, mean), np.interp(CYCLE, cycle, sd)
        apart = strides - mean
        swing, peoples = strides - strides.mean(axis=1, keepdims=True), mean - mean.mean()
        norms = np.linalg.norm(swing, axis=1) * np.linalg.norm(peoples)
        return Likeness(
            correlation=np.divide(swing @ peoples, norms, out=np.full(len(strides), np.nan), where=norms > 1e-6),
            difference=apart.mean(axis=1),
            rms=np.sqrt((apart**2).mean(axis=1)),
            inside=(np.abs(apart) <= sd).mean(axis=1),
        )


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
        people: the human range, None where no source is known.
    """

    name: str
    unit: str
    values: Array
    people: People | None = None


@dataclass(frozen=True)
class Comparison:
    """A walk compared with human gait.

    Attributes:
        strides: their number, by leg.
        curves: agreement of each leg's strides by name of the angle in ANGLES.
        measures: of steps, ground force, center of mass and effort.
    """

    strides: Mapping[Side, int]
    curves: Mapping[str, Mapping[Side, Likeness]]
    measures: tuple[Measure, ...]


def compare(signals: pa.Table, scenario: Scenario) -> Comparison:
    """Compare the steady part of a walk with human gait.

    Raises:
        ParameterError: fewer than MIN_STRIDES strides of a leg, or a walk that does not go straight ahead.
    """
    begin = scenario.controller.steady_from(scenario.subject)
    feet = {side: events_of(signals, side, begin) for side in SIDES}
    _require_walk(signals, feet, begin)
    curves = {
        name: {side: Likeness.of(over_strides(feet[side], angle.of(signals, side)), angle.people) for side in SIDES}
        for name, angle in ANGLES.items()
    }
    return Comparison(
        strides={side: len(foot.strides) for side, foot in feet.items()},
        curves=curves,
        measures=tuple(_measures(signals, scenario, feet, begin)),
    )


def late_stance_knee(strides: Array) -> Array:
    """Least knee flexion in terminal stance [deg], from knee flexion over strides, (strides, 101) -> (strides,)."""
    begin, end = TERMINAL_STANCE
    least: Array = strides[:, (begin <= CYCLE) & (end >= CYCLE)].min(axis=1)
    return least


def vertical_force(signals: pa.Table, side: Side, weight: float) -> Array:
    """Vertical force on a foot below FORCE_CUTOFF_HZ, without the impact of the heel, over `weight` [N], (rows,)."""
    force: Array = signals[f"{side.lower()}_foot.force_z_N"].to_numpy() / weight
    rate = 1.0 / float(np.median(np.diff(signals[TIME].to_numpy())))
    # A record of fewer than two samples per period of the cutoff holds nothing above it.
    if rate > 2.0 * FORCE_CUTOFF_HZ:
        force = sosfiltfilt(butter(2, FORCE_CUTOFF_HZ, fs=rate, output="sos"), force)
    return force


def force_peaks(force: Array, foot: FootEvents) -> Array:
    """First peak, valley and second peak of a force over every whole stance, shape (rows,) -> (stances, 3).

    The peaks are the greatest values in either half of the stance, the valley is the least value between them.
    """
    peaks = []
    for a, b in foot.stances:
        middle = a + max(1, (b - a) // 2)
        first, second = a + int(force[a:middle].argmax()), middle + int(force[middle:b].argmax())
        peaks.append((force[first], force[first : second + 1].min(), force[second]))
    return np.array(peaks).reshape(-1, 3)


def peak_counts(force: Array, foot: FootEvents) -> Indices:
    """Number of peaks in every whole stance that rise by MIN_VALLEY from the valleys beside them, shape (stances,)."""
    return np.array([find_peaks(force[a:b], prominence=MIN_VALLEY)[0].size for a, b in foot.stances], dtype=int)


def com_excursions(signals: pa.Table, foot: FootEvents, axis: str) -> Array:
    """Range of the center of mass in every stride along y or z, measured from the straight line
    through the ends of the stride [m].
    """
    place = signals[f"com.{axis}_m"].to_numpy()
    return np.array([np.ptp(place[a : b + 1] - np.linspace(place[a], place[b], b + 1 - a)) for a, b in foot.strides])


def peak_moments(signals: pa.Table, joint: str, sign: int, side: Side, foot: FootEvents) -> Array:
    """Greatest torque of one of JOINTS in every stride, in flexion for sign 1 and in extension for -1 [N m]."""
    torque = sign * joint_signal(signals, joint, side, "torque_N_m")
    return np.array([torque[a:b].max() for a, b in foot.strides])


def people_com_excursion(direction: str, speed: float) -> People | None:
    """Human range of the center of mass at a speed [m/s]; None outside of the two speeds of the source."""
    if not COM_SPEEDS[0] <= speed <= COM_SPEEDS[1]:
        return None
    mean, sd = (float(np.interp(speed, COM_SPEEDS, ends)) for ends in zip(*COM_EXCURSIONS[direction], strict=True))
    return People(mean - sd, mean + sd, f"{ORENDURFF}, at this speed")


def _measures(signals: pa.Table, scenario: Scenario, feet: dict[Side, FootEvents], begin: float) -> Iterator[Measure]:
    mass, time = scenario.subject.mass, signals[TIME].to_numpy()
    weight, leg = mass * GRAVITY, scenario.subject.skeleton.hip_height

    def each(measure: Callable[[Side, FootEvents], Array]) -> Array:
        return np.concatenate([measure(side, foot) for side, foot in feet.items()])

    free = f"{PERRY}, women and men at their own speed"
    speeds = each(lambda side, foot: stride_lengths(signals, side, foot) / stride_times(foot))
    yield Measure("speed", "m/s", speeds, People(1.28, 1.43, free))
    lengths = each(lambda side, foot: step_lengths(signals, side, foot))
    yield Measure("step length", "m", lengths, People(0.64, 0.73, free))
    yield Measure("cadence", "1/min", np.array([cadence(feet)]), People(111.0, 117.0, free))
    stances = each(lambda side, foot: stance_shares(foot))
    yield Measure("share of stance", "", stances, People(0.60, 0.62, PERRY))
    both = each(lambda side, foot: double_support_shares(foot, feet[other_side(side)]))
    yield Measure("share of double support", "", both, People(0.20, 0.24, PERRY))
    wanted = PREFERRED_STEP_WIDTH * leg
    widths = each(lambda side, foot: step_widths(signals, side, foot))
    yield Measure("step width", "m", widths, People(wanted, wanted, f"{DONELAN}: 0.13 of the leg's length"))

    for direction, axis in (("vertical", "z"), ("lateral", "y")):
        excursions = np.concatenate([com_excursions(signals, foot, axis) for foot in feet.values()])
        peoples = people_com_excursion(direction, float(speeds.mean()))
        yield Measure(f"center of mass, {direction} range", "m", excursions, peoples)

    forces = {side: vertical_force(signals, side, weight) for side in SIDES}
    peaks = np.concatenate([force_peaks(forces[side], foot) for side, foot in feet.items()])
    names = {"first peak": 1.1, "valley": 0.8, "second peak": 1.1}
    for column, (name, share) in zip(peaks.T, names.items(), strict=True):
        yield Measure(f"vertical GRF, {name}", "BW", column, People(share, share, PERRY))
    two = each(lambda side, foot: peak_counts(forces[side], foot) == 2)
    yield Measure("share of stances with two peaks", "", np.array([two.mean()]), People(1.0, 1.0, PERRY))

    knee = ANGLES["knee"]
    least = each(lambda side, foot: late_stance_knee(over_strides(foot, knee.of(signals, side))))
    yield Measure("least knee flexion, terminal stance", "deg", least, _people_late_stance_knee())
    cost = cost_of_transport(signals, time >= begin, mass)
    yield Measure("cost of transport", "", np.array([np.nan if cost is None else cost]))
    for joint in JOINTS:
        bends = ("dorsiflexion", "plantarflexion") if joint == "ankle" else ("flexion", "extension")
        for name, sign in zip(bends, (1, -1), strict=True):
            peaks = each(partial(peak_moments, signals, joint, sign)) / mass
            yield Measure(f"moment, {joint} {name}", "N m/kg", peaks)


def _people_late_stance_knee() -> People:
    cycle, mean, sd = people("knee_flexion_deg")
    curves = np.array([np.interp(CYCLE, cycle, curve) for curve in (mean - sd, mean + sd)])
    low, high = late_stance_knee(curves)
    return People(float(low), float(high), SCHWARTZ)


def _require_walk(signals: pa.Table, feet: dict[Side, FootEvents], begin: float) -> None:
    counts = {side: len(foot.strides) for side, foot in feet.items()}
    if min(counts.values()) < MIN_STRIDES:
        raise ParameterError(
            f"strides: {counts['Right']} of the right leg and {counts['Left']} of the left from {begin:g} s on, where"
            f" the walk is steady; allowed: from {MIN_STRIDES} of each on; walk longer, or a scenario that walks"
        )
    for side, foot in feet.items():
        ways = np.diff(matrix(signals, [f"{side.lower()}_sole.{axis}_m" for axis in "xy"])[foot.touchdowns], axis=0)
        angle = float(np.abs(np.arctan2(ways[:, 1], ways[:, 0])).max())
        if angle > MAX_HEADING:
            raise ParameterError(
                f"strides: {np.degrees(angle):.0f} deg from straight ahead (x); allowed: up to "
                f"{np.degrees(MAX_HEADING):.0f} deg, as people's were measured; compare a straight walk"
            )
