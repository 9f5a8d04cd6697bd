"""The same walk on three contact models: what they must all obey, and how far apart they may be."""

from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from scipy.optimize import brentq

from humanwalk.body import SIDES, contact_spheres, sole_patches
from humanwalk.body.skeleton import Skeleton
from humanwalk.contact.asperity import AsperityParameters, normal_force
from humanwalk.control.whole_body_parameters import WholeBodyParameters
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.sides import Side

MODELS = ("point", "hydroelastic", "asperity")
WEIGHT = 70.0 * GRAVITY
STRIDE = 0.5 / (0.6 * 1.4)
"""Of the thesis' walk: L / (beta v), E26 [s]."""


@pytest.fixture(scope="module")
def walks() -> Any:
    """By model, the last stride of the thesis' walk, at 500 Hz."""
    last = {}
    for model in MODELS:
        changes = {
            "contact": model,
            "duration": "1.6",
            "simulation.time_step": "0.001",
            "recording.signal_period": "0.002",
        }
        outcome = simulate(load_scenario("thesis", changes))
        assert outcome.survived
        time = outcome.signals["time_s"].to_numpy()
        last[model] = outcome.signals.filter(time > time[-1] - STRIDE)
    return last


def column(signals: pa.Table, name: str) -> Any:
    return signals[name].to_numpy()


@pytest.mark.parametrize("model", MODELS)
def test_ground_and_support_carry_the_weight_over_a_stride(walks: Any, model: Any) -> None:
    """Samples of 2 ms miss some of a heel strike; within 4 % of m g."""
    signals = walks[model]
    vertical = sum(column(signals, f"{side.lower()}_foot.force_z_N") for side in SIDES)
    carried = (vertical + column(signals, "support.force_z_N")).mean()
    lifted = 70.0 * np.diff(column(signals, "com.velocity_z_m_s")[[0, -1]])[0] / STRIDE
    assert carried - lifted == pytest.approx(WEIGHT, rel=0.04)


@pytest.mark.parametrize("model", ["hydroelastic", "asperity"])
def test_models_agree_on_the_walk(walks: Any, model: Any) -> None:
    reference, other = walks["point"], walks[model]
    for axis, apart in (("x", 0.01), ("y", 0.005), ("z", 0.01)):
        difference = column(other, f"com.{axis}_m") - column(reference, f"com.{axis}_m")
        assert np.abs(difference).max() < apart
    for side in SIDES:
        force, expected = (column(signals, f"{side.lower()}_foot.force_z_N").mean() for signals in (other, reference))
        assert force == pytest.approx(expected, abs=0.1 * WEIGHT)
        ahead = [
            np.average(
                column(signals, f"{side.lower()}_foot.cop_x_m") - column(signals, f"{side.lower()}_sole.x_m"),
                weights=column(signals, f"{side.lower()}_foot.force_z_N"),
            )
            for signals in (other, reference)
        ]
        assert ahead[0] == pytest.approx(ahead[1], abs=0.04)


def test_asperity_friction_is_never_more_than_the_ground_can_give(walks: Any) -> None:
    for side in SIDES:
        use = column(walks["asperity"], f"{side.lower()}_foot.friction_use")
        assert use.max() <= 1.0 + 1e-9
        assert use.max() > 0.3


@pytest.mark.parametrize("side", SIDES)
def test_a_foot_that_stands_on_its_heel_points_is_not_tilted_off_the_others(skeleton: Skeleton, side: Side) -> None:
    """The whole-body program counts on points below `contact_height`: beyond, it would count on the heel for good."""
    law, bodies = AsperityParameters(), (f"{side}Leg_Ankle", f"{side}Leg_FootMiddle")
    heel, ball = (
        np.mean([s.center[0] + skeleton.origins[body][0] for s in contact_spheres(skeleton) if s.body == body])
        for body in bodies
    )
    (patch,) = (patch for patch in sole_patches(skeleton, side) if patch.body == bodies[0])
    x = patch.p_BoQ_B[:, 0] + skeleton.origins[bodies[0]][0]

    def forces(sunk: float, tilt: float) -> Array:
        height = tilt * (x - heel) - sunk
        return normal_force(law, -law.normal_stiffness * patch.area * height, height)

    def ahead_of_heel(tilt: float) -> float:
        sunk = brentq(lambda depth: forces(depth, tilt).sum() - WEIGHT, -0.1, 0.1)
        return np.average(x, weights=forces(sunk, tilt)) - heel

    assert brentq(ahead_of_heel, 0.0, 1.0) * (ball - heel) < WholeBodyParameters().contact_height
