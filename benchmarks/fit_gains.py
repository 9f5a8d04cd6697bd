"""Fits gains of the balanced walk to the goals of likeness: python benchmarks/fit_gains.py [GAIN ...]

Measures how every gain changes the values of the goals and the nine curves of the score, in the walks of the shipped
study `likeness`: three speeds, two contact models, without and with the style. Searches the gains that would be best if
these changes added up, and walks with them. A round takes some 80 s per gain on two cores. Prints what every trial
reaches, and the gains of those that are better.

A GAIN is a part of a name, such as `swing`; without any, all of GAINS are fitted.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import batched
from typing import NamedTuple

import numpy as np
from dask.distributed import Client, Future
from likeness import CONTACT, FORWARD, GAIT, GOALS, STUDY, Goal, Row
from scipy.optimize import minimize
from scipy.special import expit

from humanwalk.cli.common import counted_progress
from humanwalk.measures.curves import CURVES, JOINTS
from humanwalk.measures.human_likeness import SCORED
from humanwalk.measures.walk_measures import Walk
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, numbers_of
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario
from humanwalk.study.cluster import local_client
from humanwalk.study.design import Point
from humanwalk.study.row import measured
from humanwalk.study.study import load_study

DURATION = 15.0
"""Of a walk [s]: the goals depend on its worst strides."""

LARGEST_CHANGES = (1.0, 0.5, 0.25)
"""Largest changes of the gains in a round, in steps: the next one is tried if the one before is no better."""

STEEPNESS = 2.0
"""Slope of the smooth loss of a goal at its limit, per distance of UNITS."""

CHANGE_COST, SQUARE_COST = 0.15, 0.1
"""What a step of a gain costs, and what its square costs [goals]."""

DISTANCE_COST, SCORE_GAIN = 0.1, 0.8
"""What a goal costs per distance of UNITS by which it is missed, and what one percent of the mean score is worth
[goals]."""

MAX_ITERATIONS = 60
"""Of the search among predicted changes: each takes some 0.2 s with 33 gains."""

EDGE = 0.125
"""Width of the smooth edge of the range within one standard deviation, in standard deviations."""


class Gain(NamedTuple):
    """A gain that is fitted.

    Attributes:
        step: change from which its effect is measured; its effect is large against the differences between strides.
        low, high: its range.
    """

    step: float
    low: float
    high: float


PLANNER, PROGRAM = "controller.balanced.planner.", "controller.balanced.whole_body."
GAINS: Mapping[str, Gain] = {
    PLANNER + "timing.walk_ratio": Gain(0.008, 0.33, 0.39),
    PLANNER + "timing.double_support": Gain(0.008, 0.05, 0.14),
    PLANNER + "timing.double_support_exponent": Gain(0.2, 0.5, 2.5),
    PLANNER + "support.center": Gain(0.006, -0.02, 0.06),
    PLANNER + "support.roll": Gain(0.012, 0.05, 0.2),
    PLANNER + "support.pivot": Gain(0.012, 0.03, 0.15),
    PLANNER + "support.ball": Gain(0.012, 0.03, 0.16),
    PLANNER + "rockers.heel": Gain(0.015, 0.05, 0.25),
    PLANNER + "rockers.ball": Gain(0.02, 0.12, 0.3),
    PLANNER + "rockers.pitch": Gain(0.05, 0.9, 1.5),
    PLANNER + "rockers.late_rise": Gain(0.1, 0.0, 1.0),
    PLANNER + "rockers.speed_exponent": Gain(0.12, 0.2, 1.5),
    PLANNER + "rockers.toes": Gain(0.06, 0.3, 0.9),
    PLANNER + "rockers.toe_range": Gain(0.06, 0.05, 0.3),
    PLANNER + "swing.lift": Gain(0.006, 0.015, 0.09),
    PLANNER + "swing.mid_height": Gain(0.04, 0.35, 0.8),
    PLANNER + "swing.late_height": Gain(0.03, 0.1, 0.45),
    PLANNER + "swing.early_pitch": Gain(0.035, -0.2, 0.1),
    PLANNER + "swing.mid_pitch": Gain(0.03, 0.3, 0.6),
    PLANNER + "swing.late_pitch": Gain(0.03, 0.7, 1.0),
    PLANNER + "swing.toe_up": Gain(0.025, 0.18, 0.35),
    PLANNER + "swing.push_off": Gain(0.6, 4.0, 12.0),
    PLANNER + "swing.landing_speed_ratio": Gain(0.05, 0.3, 0.9),
    PLANNER + "swing.landing_deceleration": Gain(2.0, 10.0, 35.0),
    PLANNER + "swing.landing_sink_rate": Gain(0.06, 0.0, 0.4),
    PLANNER + "swing.slow_landing_sink_rate": Gain(0.06, 0.0, 0.4),
    PLANNER + "rockers.unloading": Gain(3.0, 4.0, 20.0),
    PLANNER + "rockers.unloading_force": Gain(0.7, 1.5, 10.0),
    PLANNER + "height.walking": Gain(0.0025, 0.99, 1.03),
    PLANNER + "height.amplitude": Gain(0.0045, 0.0, 0.05),
    PLANNER + "height.delay": Gain(0.008, -0.04, 0.08),
    PLANNER + "rotation.pelvis": Gain(0.03, 0.03, 0.3),
    PLANNER + "rotation.drop": Gain(0.012, 0.0, 0.1),
    PLANNER + "rotation.arms": Gain(0.2, 0.0, 1.2),
    PROGRAM + "com_weight": Gain(100.0, 150.0, 1500.0),
    PROGRAM + "com_height.weight": Gain(70.0, 100.0, 600.0),
    PROGRAM + "torque_unit": Gain(1.0, 2.0, 20.0),
    PROGRAM + "force_pivot.height": Gain(0.15, 0.1, 1.2),
    PROGRAM + "force_pivot.unit": Gain(1.2, 2.0, 20.0),
    PROGRAM + "heel_off.weight": Gain(12.0, 15.0, 150.0),
    PROGRAM + "heel_strike.stiffness": Gain(250.0, 200.0, 3000.0),
    PROGRAM + "swing_position.weight": Gain(12.0, 10.0, 150.0),
    PROGRAM + "pelvis.weight": Gain(0.6, 0.5, 10.0),
    PROGRAM + "chest.weight": Gain(2.0, 2.0, 30.0),
    PROGRAM + "knee_margin": Gain(0.012, 0.02, 0.12),
    PROGRAM + "spine.weight": Gain(0.15, 0.1, 2.0),
    PROGRAM + "stance.damping": Gain(6.0, 16.0, 80.0),
}

UNITS: Mapping[str, float] = {
    "angles within 1 SD, mean [%]": 5.0,
    "angles within 1 SD: hip, knee, ankle [%]": 5.0,
    "angles, correlation": 0.02,
    "moments within 1 SD, mean [%]": 4.0,
    "moments, correlation": 0.03,
    "moments, peak / human": 0.12,
    "powers within 1 SD, mean [%]": 4.0,
    "vertical GRF, peaks [BW]": 0.025,
    "vertical GRF, dip [BW]": 0.025,
    "share of stance": 0.008,
    "share of double support": 0.012,
    "cadence [1/min]": 2.0,
    "step length [m]": 0.007,
    "step width [m]": 0.01,
    "cost of transport": 0.03,
}
"""Distance from the limit of a goal that counts as one. Goals that depend on one sample of the worst stride are not
here: they do not change in proportion to the gains."""

PREDICTED = {"angles": "", "moments": " moment", "powers": " power"}
"""Curves whose shares within one standard deviation follow from the changes of the curves."""


Walked = tuple[Row, Mapping[str, Array]]
"""A walk: its row of the study, and its mean strides less people's in standard deviations, by curve."""


def walk(scenario: Scenario, case: Row) -> Walked | None:
    """A walk and the values of its factors; None for one that fell or cannot be compared."""
    try:
        outcome = simulate(scenario)
        row = measured(outcome)
    except ParameterError:
        return None
    if "likeness.score" not in row:
        return None
    steady = Walk.of(outcome.signals, scenario)
    bands = {curve: CURVES[curve].people(steady.pace.group, steady.pace.leg) for curve in SCORED}
    means = {curve: steady.strides(curve).mean(axis=0) for curve in SCORED}
    return {**row, **case}, {curve: (means[curve] - bands[curve].mean) / bands[curve].sd for curve in SCORED}


def share_within(curve: Array) -> float:
    """Share of a curve within one standard deviation [%], with a smooth edge."""
    return 100.0 * float(expit((1.0 - np.abs(curve)) / EDGE).mean())


def miss(goal: Goal, values: Array, row: Row) -> float:
    """Distance of the worst value from the limits of a goal, negative within them, in UNITS."""
    limits = goal.target(row).limits(row)
    worst = max(max(low - value, value - high) for value, (low, high) in zip(values, limits, strict=True))
    return float(worst) / UNITS[goal.name]


def goals_reached(walks: Sequence[Walked]) -> int:
    """Number of goals that are reached."""
    return sum(goal.reached(row) for row, _ in walks for goal in GOALS)


def told(walks: Sequence[Walked] | None) -> str:
    """Goals and merit of walks, as text."""
    return f"{goals_reached(walks)} goals, merit {merit(walks):.2f}" if walks else "a walk fell or cannot be compared"


def merit(walks: Sequence[Walked]) -> float:
    """Goals reached, less the cost of the distances of the others, plus the worth of the mean score [goals]."""
    distance = sum(
        max(miss(goal, np.array(goal.values(row)), row), 0.0)
        for row, _ in walks
        for goal in GOALS
        if goal.name in UNITS and goal.counts(row)
    )
    score = np.mean([100.0 * row["likeness.score"] for row, _ in walks])
    return float(goals_reached(walks) - DISTANCE_COST * distance + SCORE_GAIN * score)


class Fit:
    """The walks of the study as a function of the gains, in steps from their values there."""

    def __init__(self, parts: Sequence[str], client: Client) -> None:
        """Prepare the fit.

        Args:
            parts: of the names of the gains that are fitted; all without any.
            client: of the workers.

        Raises:
            ParameterError: no gain has such a name.
        """
        self._study, self._client = load_study(STUDY), client
        self.names = [name for name in GAINS if not parts or any(part in name for part in parts)]
        if not self.names:
            raise ParameterError(
                f"GAIN: {' '.join(parts)}; allowed: parts of the names in GAINS; take swing or torque_unit"
            )
        first = self._study.scenario_at(self._study.points[0])
        start = {name: value for name, value, _ in numbers_of(first)}
        self._start = np.array([start[name] for name in self.names])
        self._step, self._low, self._high = np.array([GAINS[name] for name in self.names]).T

    def gains(self, steps: Array) -> dict[str, float]:
        """Gains at a number of steps from the start, within their ranges."""
        values = np.clip(self._start + steps * self._step, self._low, self._high)
        return dict(zip(self.names, values.tolist(), strict=True))

    def walks(self, *steps: Array) -> list[list[Walked] | None]:
        """The walks of the study at every number of steps; None where one fell."""
        points = self._study.points
        jobs = [self._submit(change, point) for change in steps for point in points]
        with counted_progress("walks", estimate_period=600.0) as progress:
            found = list(progress.track((job.result() for job in jobs), total=len(jobs), description=STUDY))
        every = [[each for each in walks if each is not None] for walks in batched(found, len(points))]
        return [walks if len(walks) == len(points) else None for walks in every]

    def signs(self, point: Array) -> Array:
        """Directions in which a step of each gain stays within its range."""
        return np.where(self._start + (point + 1.0) * self._step <= self._high, 1.0, -1.0)

    def _submit(self, steps: Array, point: Point) -> Future[Walked | None]:
        changed = {**self._study.set, **self.gains(steps), "duration": DURATION}
        scenario = replace(self._study, set=changed).scenario_at(point)
        case = {name: self._study.value_at(point, name) for name in (CONTACT, FORWARD, GAIT)}
        return self._client.submit(walk, scenario, case, pure=False)


class Case(NamedTuple):
    """The walk of a case, and how a step of each gain changes it.

    Attributes:
        row: of the study.
        values: of the goals of UNITS, and their slopes, (gains, values), by goal.
        curves: as in `Walked`, (101,), and their slopes, (gains, 101), by curve.
    """

    row: Row
    values: Mapping[str, tuple[Array, Array]]
    curves: Mapping[str, tuple[Array, Array]]

    @staticmethod
    def of(base: Walked, changed: Sequence[Walked], signs: Array) -> "Case":
        """The case of a walk.

        Args:
            base: the walk.
            changed: the walks with one gain each changed.
            signs: of these changes, (gains,).
        """
        (row, curves), values = base, _values(base[0])
        changed_values = [_values(other) for other, _ in changed]
        return Case(
            row,
            {
                goal: (value, _slopes([each[goal] for each in changed_values], value, signs))
                for goal, value in values.items()
            },
            {
                name: (curve, _slopes([each[name] for _, each in changed], curve, signs))
                for name, curve in curves.items()
            },
        )

    def loss(self, steps: Array) -> tuple[float, float]:
        """Goals that are missed, with smooth limits and the cost of their distance, and change of the score [%]."""
        more = {
            name: share_within(curve + steps @ slopes) - share_within(curve)
            for name, (curve, slopes) in self.curves.items()
        }
        share_changes = _share_changes(more)
        missed = 0.0
        for goal in GOALS:
            if goal.name in UNITS and goal.counts(self.row):
                value, slopes = self.values[goal.name]
                changed = value + share_changes.get(goal.name, steps @ slopes)
                distance = miss(goal, changed, self.row)
                missed += float(expit(STEEPNESS * distance)) + DISTANCE_COST * max(distance, 0.0)
        return missed, float(np.mean(list(more.values())))


def best_steps(cases: Sequence[Case], gains: int, largest: float) -> Array:
    """Steps of the gains, up to a largest change, that are best for goals and score if changes add up, (gains,)."""

    def loss(steps: Array) -> float:
        missed, score = np.array([case.loss(steps) for case in cases]).T
        cost = CHANGE_COST * (np.sqrt(steps**2 + 0.01) - 0.1) + SQUARE_COST * steps**2
        return float(missed.sum() - SCORE_GAIN * score.mean() + cost.sum())

    bounds, options = [(-largest, largest)] * gains, {"maxiter": MAX_ITERATIONS}
    found: Array = minimize(loss, np.zeros(gains), method="L-BFGS-B", bounds=bounds, options=options).x
    return found


def _values(row: Row) -> dict[str, Array]:
    """Values of the goals of UNITS."""
    return {goal.name: np.array(goal.values(row)) for goal in GOALS if goal.name in UNITS}


def _slopes(changed: Sequence[Array], base: Array, signs: Array) -> Array:
    """Changes of an array by a step of each gain, (gains, size)."""
    return signs[:, None] * (np.array(changed) - base)


def _share_changes(more: Mapping[str, float]) -> dict[str, Array]:
    """Changes of the goals of shares within one standard deviation, from those of the curves [%], by goal."""
    changes = {
        quantity: np.array([more[f"{joint}{curve}"] for joint in JOINTS]) for quantity, curve in PREDICTED.items()
    }
    means = {f"{quantity} within 1 SD, mean [%]": change.mean(keepdims=True) for quantity, change in changes.items()}
    return means | {"angles within 1 SD: hip, knee, ankle [%]": changes["angles"]}


def main(*parts: str) -> None:
    """Fit the gains whose names contain one of the parts, and print them."""
    with local_client() as client:
        fit = Fit(parts, client)
        point = np.zeros(len(fit.names))
        (base,) = fit.walks(point)
        if not base:
            raise ParameterError(f"{STUDY}: one of its walks falls; allowed: a study whose walks are completed")
        print(f"{told(base)}\n", flush=True)
        is_better = True
        while is_better:
            signs = fit.signs(point)
            # A gain whose change makes a walk fall is left alone.
            changed = [walks or base for walks in fit.walks(*(point + np.diag(signs)))]
            cases = [Case.of(*walks, signs) for walks in zip(base, zip(*changed, strict=True), strict=True)]
            is_better = False
            for largest in LARGEST_CHANGES:
                trial = point + best_steps(cases, point.size, largest)
                (found,) = fit.walks(trial)
                print(f"changes of up to {largest:g} steps: {told(found)}\n", flush=True)
                if found and merit(found) > merit(base):
                    point, base, is_better = trial, found, True
                    for name, value in fit.gains(point).items():
                        print(f"{name}: {value:.4g}", flush=True)
                    break


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except ParameterError as error:
        sys.exit(f"fit_gains: {error}")
