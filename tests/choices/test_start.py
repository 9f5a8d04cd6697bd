"""The start: the angles that are asked for, noise within the ranges, and soles on the ground whatever they are."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body import contact_spheres
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.body.plant import body_plant, kinematics_plant
from humanwalk.body.skeleton import Skeleton
from humanwalk.choices import ThesisController, start
from humanwalk.choices.start import StartParameters
from humanwalk.control.reach import require_reachable
from humanwalk.diagrams.world import add_world
from humanwalk.gait.foot_cycle import minimum_offset
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario, shipped_scenarios


def start_positions(scenario: Scenario) -> Array:
    posture = scenario.controller.start_posture(scenario.subject, scenario.terrain)
    return start.start_positions(scenario.subject, scenario.terrain, scenario.start, posture, scenario.seed)


def start_velocities(scenario: Scenario) -> Array:
    return start.start_velocities(scenario.subject, scenario.start, scenario.seed)


def human_gains(scenario: Scenario) -> tuple[Array, Array]:
    world = add_world(DiagramBuilder(), scenario)
    return world.kp, world.kd


def require_thesis_reachable(scenario: Any) -> None:
    controller = scenario.controller
    require_reachable(scenario.subject, controller.gait.path, controller.inverse_kinematics)


def lowest_point(plant: Any, skeleton: Skeleton, q: Array) -> float:
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, q)
    return min(
        plant.GetBodyByName(sphere.body).EvalPoseInWorld(context).multiply(sphere.center)[2] - sphere.radius
        for sphere in contact_spheres(skeleton)
    )


@settings(max_examples=40)
@given(st.data())
def test_lowest_point_of_the_soles_touches_the_ground(
    plant: MultibodyPlant, skeleton: Skeleton, joints: JointMap, data: Any
) -> None:
    chosen = data.draw(st.lists(st.integers(0, 41), max_size=5, unique=True))
    angles = {
        joints.names[i]: data.draw(st.floats(max(joints.lower[i], -3.1), min(joints.upper[i], 3.1))) for i in chosen
    }
    q = start_positions(Scenario(start=StartParameters(joint_angles=angles)))
    assert lowest_point(plant, skeleton, q) == pytest.approx(0.0, abs=1e-9)
    for name, angle in angles.items():
        assert q[joints.q[joints.names.index(name)]] == angle


def test_start_faces_forward_above_the_origin() -> None:
    q = start_positions(Scenario())
    np.testing.assert_array_equal(q[:6], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_noise_stays_within_the_ranges_and_has_the_size_that_is_asked_for(
    plant: MultibodyPlant, skeleton: Skeleton, joints: JointMap
) -> None:
    calm = start_positions(Scenario())[joints.q]
    errors = []
    for seed in range(20):
        q = start_positions(Scenario(seed=seed, start=StartParameters(joint_noise=0.02)))
        assert (q[joints.q] >= joints.lower).all()
        assert (q[joints.q] <= joints.upper).all()
        assert lowest_point(plant, skeleton, q) == pytest.approx(0.0, abs=1e-9)
        errors.append(q[joints.q] - calm)
    inside = (calm - joints.lower > 0.1) & (joints.upper - calm > 0.1)
    assert inside.sum() > 20
    assert np.std(np.array(errors)[:, inside]) == pytest.approx(0.02, rel=0.1)


def test_the_body_starts_at_rest_unless_rates_are_noisy(joints: JointMap) -> None:
    assert not start_velocities(Scenario(seed=3)).any()
    rates = np.array([start_velocities(Scenario(seed=s, start=StartParameters(rate_noise=0.1))) for s in range(20)])
    assert not rates[:, :6].any()
    assert np.std(rates[:, joints.v]) == pytest.approx(0.1, rel=0.1)


@pytest.mark.parametrize("joint", ["elbow: {upper: 0.2}", "elbow: {lower: 1.0}", "shoulder_flexion: {lower: 0.3}"])
def test_an_impaired_joint_starts_as_near_to_the_posture_as_it_reaches(joint: str) -> None:
    name, limits = joint.split(": ", 1)
    impairment = f"[{{joint: {{joint: {name}, side: Right, {limits.strip('{}')}}}}}]"
    healthy, impaired = (load_scenario("walk", {"subject.impairments": text}) for text in ("[]", impairment))
    joints = JointMap.of(body_plant(impaired.subject))
    posture, start = (joints.positions(start_positions(scenario)) for scenario in (healthy, impaired))
    np.testing.assert_allclose(start, np.clip(posture, joints.lower, joints.upper), atol=1e-12)
    assert np.abs(start - posture).max() > 0.1


def test_a_start_beyond_a_range_that_the_walker_does_not_know_is_refused() -> None:
    overrides = {
        "subject.impairments": "[{stiff_knee: {known: false}}]",
        "start.joint_angles": f"{{{LEGS['Right'].knee}: 0.6}}",
    }
    with pytest.raises(ParameterError, match=r"0\.6 is beyond the joint's range"):
        start_positions(load_scenario("walk", overrides))


def test_noise_of_rates_gains_and_angles_is_independent(joints: JointMap) -> None:
    noise = StartParameters(joint_noise=1e-3, rate_noise=1e-3, gain_noise=1e-3)
    calm, noisy = Scenario(seed=5), Scenario(seed=5, start=noise)
    errors = np.array(
        [
            (start_positions(noisy) - start_positions(calm))[joints.q],
            start_velocities(noisy)[joints.v],
            *(np.log(after / before) for before, after in zip(human_gains(calm), human_gains(noisy), strict=True)),
        ]
    )
    inside = (np.abs(errors[0]) > 0.0) & np.isfinite(errors).all(axis=0)
    assert inside.sum() > 25
    assert np.abs(np.corrcoef(errors[:, inside]) - np.eye(4)).max() < 0.5
    np.testing.assert_allclose(np.std(errors[:, inside], axis=1), 1e-3, rtol=0.35)


def standing(loads: str) -> tuple[float, Array, Array]:
    """Center of mass before the ankle [m], rotation of the right sole, and of the pelvis, at the start of a walk."""
    scenario = load_scenario("walk", {"subject.loads": loads})
    plant = kinematics_plant(scenario.subject)
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, start_positions(scenario))
    ankle, pelvis = (plant.GetFrameByName(name).CalcPoseInWorld(context) for name in (LEGS["Right"].sole, PELVIS))
    com = plant.CalcCenterOfMassPositionInWorld(context)
    return float(com[0] - ankle.translation()[0]), ankle.rotation().matrix(), pelvis.rotation().matrix()


@pytest.mark.parametrize("mass", [5, 20, 40])
def test_the_balanced_walker_leans_against_the_loads_that_it_knows(mass: int) -> None:
    free, level, upright = standing("[]")
    np.testing.assert_array_equal(upright, np.eye(3))
    ahead, sole, pelvis = standing(f"[{{backpack: {{mass: {mass}}}}}]")
    # Bent legs move the lean's pivot: the compensation is good to a centimeter, of 12 cm at most.
    assert ahead == pytest.approx(free, abs=0.01)
    assert pelvis[0, 2] > 0.0
    np.testing.assert_allclose(sole, level, atol=1e-12)
    unknown, _, still_upright = standing(f"[{{backpack: {{mass: {mass}, known: false}}}}]")
    assert unknown == free
    np.testing.assert_array_equal(still_upright, np.eye(3))


@pytest.mark.parametrize(
    "name", [name for name in shipped_scenarios() if isinstance(load_scenario(name).controller, ThesisController)]
)
def test_shipped_gaits_are_reachable(name: str) -> None:
    require_thesis_reachable(load_scenario(name))


@pytest.mark.parametrize("step_length", [0.4, 0.5, 0.6])
def test_offset_is_refused_below_the_least_and_named_with_a_mend(step_length: float) -> None:
    least = minimum_offset(step_length, load_scenario("thesis").subject.skeleton.leg_length)
    overrides = {
        "controller.thesis.gait.path.step_length": str(step_length),
        "controller.thesis.gait.path.offset": str(least - 1e-4),
    }
    with pytest.raises(ParameterError, match=rf"allowed: from {least:.4f} m on"):
        require_thesis_reachable(load_scenario("thesis", overrides))


@pytest.mark.parametrize("side", ["Right", "Left"])
def test_both_legs_have_to_reach(side: str) -> None:
    impairment = f"[{{joint: {{joint: ankle, side: {side}, upper: 0.45}}}}]"
    with pytest.raises(ParameterError, match=rf"{side}\w+ at the end of its range"):
        require_thesis_reachable(load_scenario("thesis", {"subject.impairments": impairment}))


def test_taller_body_reaches_with_an_offset_that_the_reference_needs_too() -> None:
    # E32: a longer leg needs less of an offset for the same step.
    overrides = {
        "controller.thesis.gait.path.offset": "0.0355",
        "controller.thesis.gait.path.step_height": "0.1",
        "controller.thesis.gait.path.toe_drop": "0.2",
    }
    with pytest.raises(ParameterError, match=r"gait\.path\.offset"):
        require_thesis_reachable(load_scenario("thesis", overrides))
    require_thesis_reachable(load_scenario("thesis", overrides | {"subject.stature": "1.95"}))


def test_an_unknown_joint_is_refused_with_the_nearest_or_all() -> None:
    for name, end in (
        ("HeadMotion", r"; did you mean Head_Motion\?"),
        ("shin", ": RightLegFemurMotion, .*WristMotion"),
    ):
        wrong = Scenario(start=StartParameters(joint_angles={name: 0.1}))
        with pytest.raises(ParameterError, match=f"{name}: no such joint; allowed: the 42 joints of the body{end}"):
            start_positions(wrong)
