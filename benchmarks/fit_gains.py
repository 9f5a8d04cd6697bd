"""Fits gains of the balanced walk to people's curves: python benchmarks/fit_gains.py [SCENARIO [GAIN ...]]

Least squares over the nine curves of the score, at three speeds on both contact models, and over limits of single
measures. An iteration changes every gain once: some ten minutes on two cores. Prints the gains after every iteration.

SCENARIO is `walk`, `normative` or a file; default: `walk`. A GAIN is a part of a name, such as `swing`; without any,
all of GAINS are fitted.
"""

import sys
from collections.abc import Mapping, Sequence
from functools import partial
from itertools import batched, product
from typing import NamedTuple

import numpy as np
from dask.distributed import Client
from scipy.optimize import OptimizeResult, least_squares

from humanwalk.cli.common import counted_progress
from humanwalk.gait.normative import CYCLE
from humanwalk.measures.curves import CURVES
from humanwalk.measures.human_likeness import SCORED
from humanwalk.measures.walk_measures import MEASURES, Walk
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, numbers_of
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.study.cluster import local_client

CASES = tuple(product(("point", "hydroelastic"), (0.9, 1.2, 1.4)))
"""Contact model and speed [m/s] of the walks."""

SPEED = "controller.balanced.command.points.0.forward"

DURATION = "11.5"
"""Of a walk [s]: some four strides of each leg after the walk is steady."""

EVERY = 2
"""Points of the gait cycle per point that counts."""

FALLEN = 10.0
"""Error of every point of a walk that fell, or that cannot be compared."""

MAX_TRIALS = 20
"""Largest number of sets of gains that are tried, besides those that are changed one by one."""

LIMIT_WEIGHT = 3.0
"""Weight of the error of a measure against that of a point of a curve."""


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
    PLANNER + "swing.lift": Gain(0.006, 0.015, 0.09),
    PLANNER + "swing.mid_height": Gain(0.04, 0.35, 0.8),
    PLANNER + "swing.late_height": Gain(0.03, 0.1, 0.45),
    PLANNER + "swing.early_pitch": Gain(0.035, -0.2, 0.1),
    PLANNER + "swing.mid_pitch": Gain(0.03, 0.3, 0.6),
    PLANNER + "swing.toe_up": Gain(0.025, 0.18, 0.35),
    PLANNER + "swing.push_off": Gain(0.6, 4.0, 12.0),
    PLANNER + "swing.landing_speed_ratio": Gain(0.05, 0.3, 0.9),
    PLANNER + "swing.landing_deceleration": Gain(2.0, 10.0, 35.0),
    PLANNER + "swing.landing_sink_rate": Gain(0.06, 0.0, 0.4),
    PLANNER + "height.walking": Gain(0.0025, 0.99, 1.03),
    PLANNER + "height.amplitude": Gain(0.0012, 0.0, 0.014),
    PLANNER + "height.delay": Gain(0.008, -0.04, 0.08),
    PLANNER + "rotation.pelvis": Gain(0.03, 0.03, 0.3),
    PLANNER + "rotation.drop": Gain(0.012, 0.0, 0.1),
    PROGRAM + "com_weight": Gain(100.0, 150.0, 1500.0),
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

LIMITS: Mapping[str, tuple[float, float, float]] = {
    "vertical GRF, first peak": (1.07, 1.23, 0.05),
    "vertical GRF, dip": (0.72, 0.88, 0.05),
    "vertical GRF, second peak": (1.07, 1.23, 0.05),
    "contact lost after heel strike": (0.0, 0.0, 0.015),
    "CoP backward": (0.0, 0.008, 0.01),
    "cost of transport": (0.0, 0.4, 0.03),
}
"""Range of a measure, and the distance from it that counts as one standard deviation, in the unit of the measure."""


def errors(scenario: Scenario) -> Array:
    """Of one walk: mean strides less people's in standard deviations, then the weighted errors of LIMITS."""
    size = len(SCORED) * len(CYCLE[::EVERY]) + len(LIMITS)
    try:
        outcome = simulate(scenario)
    except ParameterError:
        return np.full(size, FALLEN)
    if not outcome.survived:
        return np.full(size, FALLEN)
    walk = Walk.of(outcome.signals, scenario)
    if not all(foot.strides for foot in walk.feet.values()):
        return np.full(size, FALLEN)
    bands = [CURVES[curve].people(walk.pace.group, walk.pace.leg) for curve in SCORED]
    strides = [walk.strides(curve).mean(axis=0) for curve in SCORED]
    curves = [((mean - band.mean) / band.sd)[::EVERY] for mean, band in zip(strides, bands, strict=True)]
    measured = [(kind.of_walk(walk).value, *LIMITS[kind.name]) for kind in MEASURES if kind.name in LIMITS]
    limits = [(value - min(max(value, low), high)) / unit for value, low, high, unit in measured]
    return np.concatenate((*curves, LIMIT_WEIGHT * np.array(limits)))


def saturating(squares: Array) -> Array:
    """Geman and McClure's loss z / (1 + z) of squared errors z, and its first two derivatives, (3, errors)."""
    return np.array((squares / (1.0 + squares), (1.0 + squares) ** -2, -2.0 * (1.0 + squares) ** -3))


class Fit:
    """Errors of the walks as a function of the gains, in steps from their values in a scenario."""

    def __init__(self, scenario: str, parts: Sequence[str], client: Client) -> None:
        """Prepare the fit.

        Args:
            scenario: name or path.
            parts: of the names of the gains that are fitted; all without any.
            client: of the workers.

        Raises:
            ParameterError: the scenario cannot be used, or no gain has such a name.
        """
        self.scenario, self.client = scenario, client
        self.names = [name for name in GAINS if not parts or any(part in name for part in parts)]
        if not self.names:
            raise ParameterError(
                f"GAIN: {' '.join(parts)}; allowed: parts of the names in GAINS; take swing or torque_unit"
            )
        start = {name: value for name, value, _ in numbers_of(load_scenario(scenario))}
        missing = [name for name in self.names if name not in start]
        if missing:
            raise ParameterError(f"SCENARIO: {scenario} has no {missing[0]}; allowed: balanced walks; take walk")
        self._start = np.array([start[name] for name in self.names])
        self._step, self._low, self._high = np.array([GAINS[name] for name in self.names]).T

    def gains(self, steps: Array) -> dict[str, float]:
        """Gains at a number of steps from the start, within their ranges."""
        values = np.clip(self._start + steps * self._step, self._low, self._high)
        return dict(zip(self.names, values.tolist(), strict=True))

    def errors(self, *points: Array) -> list[Array]:
        """Errors of all cases, one array per point."""
        jobs = [self.client.submit(errors, walk, pure=False) for point in points for walk in self.walks(point)]
        with counted_progress("walks", estimate_period=600.0) as progress:
            found = list(progress.track((job.result() for job in jobs), total=len(jobs), description=self.scenario))
        return [np.concatenate(cases) for cases in batched(found, len(CASES))]

    def walks(self, point: Array) -> list[Scenario]:
        """The walks of all cases."""
        common = {name: repr(value) for name, value in self.gains(point).items()} | {"duration": DURATION}
        return [load_scenario(self.scenario, {**common, "contact": on, SPEED: str(v)}) for on, v in CASES]

    def at(self, point: Array) -> Array:
        """Errors at one point."""
        return self.errors(point)[0]

    def slopes(self, point: Array) -> Array:
        """Changes of the errors by one step of every gain, (errors, gains)."""
        here, *beside = self.errors(point, *(point + np.eye(len(point))))
        return np.array(beside).T - here[:, None]


def show(fit: Fit, intermediate_result: OptimizeResult) -> None:
    """Print the gains and the loss of an iteration."""
    for name, value in fit.gains(intermediate_result.x).items():
        print(f"{name}: {value:.4g}")
    print(f"loss {intermediate_result.cost:.1f}\n", flush=True)


def main(scenario: str = "walk", *parts: str) -> None:
    """Fit the gains whose names contain one of the parts, and print them."""
    with local_client() as client:
        fit = Fit(scenario, parts, client)
        least_squares(
            fit.at,
            np.zeros(len(fit.names)),
            jac=fit.slopes,
            loss=saturating,
            f_scale=2.0,
            x_scale=3.0,
            max_nfev=MAX_TRIALS,
            callback=partial(show, fit),
        )


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except ParameterError as error:
        sys.exit(f"fit_gains: {error}")
