"""Gains of the joints: what the thesis prints, and presets for the rest."""

from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS, group_of
from humanwalk.control.joint_gains import STIFFNESS_BY_GROUP, THESIS_ANKLE, JointGains, PdGains, joint_gains
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError

KNEE = LEGS["Right"].knee


@pytest.fixture(scope="module")
def inertia(plant: MultibodyPlant, joints: JointMap) -> Array:
    return plant.CalcMassMatrix(plant.CreateDefaultContext()).diagonal()[joints.v]


def test_thesis_preset_gives_the_ankles_the_printed_gains(plant: MultibodyPlant, joints: JointMap) -> None:
    kp, kd = joint_gains(plant, JointGains())
    ankles = [i for i, name in enumerate(joints.names) if group_of(name) == "ankle"]
    assert len(ankles) == 6
    assert {(kp[i], kd[i]) for i in ankles} == {THESIS_ANKLE} == {(10000.0, 10.0)}


@pytest.mark.parametrize("preset", ["thesis", "damped"])
def test_every_other_joint_has_the_damping_ratio(plant: Any, joints: JointMap, inertia: Array, preset: Any) -> None:
    kp, kd = joint_gains(plant, JointGains(preset=preset, damping_ratio=0.7))
    ratio = kd / (2 * np.sqrt(kp * inertia))
    for name, zeta in zip(joints.names, ratio, strict=True):
        if preset == "damped" or group_of(name) != "ankle":
            assert zeta == pytest.approx(0.7), name


def test_stiffness_scale_leaves_named_gains_alone(plant: MultibodyPlant, joints: JointMap) -> None:
    named = {KNEE: PdGains(kp=123.0, kd=4.0)}
    softer, _ = joint_gains(plant, JointGains("damped", stiffness_scale=0.5, joints=named))
    full, kd = joint_gains(plant, JointGains("damped", joints=named))
    knee = joints.names.index(KNEE)
    assert (softer[knee], full[knee], kd[knee]) == (123.0, 123.0, 4.0)
    np.testing.assert_allclose(np.delete(softer, knee), 0.5 * np.delete(full, knee))


def test_left_and_right_have_equal_gains(plant: MultibodyPlant, joints: JointMap) -> None:
    kp, kd = joint_gains(plant, JointGains())
    for i, name in enumerate(joints.names):
        twin = joints.names.index(name.replace("Right", "Left"))
        assert (kp[i], kd[i]) == pytest.approx((kp[twin], kd[twin]))


def test_gains_for_no_joint_of_the_body_are_refused_with_the_nearest_name(plant: MultibodyPlant) -> None:
    parameters = JointGains(joints={"RightLegTibia": PdGains(1.0, 1.0)})
    with pytest.raises(
        ParameterError, match=r"^gains\.joints\.RightLegTibia: .*42 joints.*did you mean RightLegTibiaMotion\?"
    ):
        joint_gains(plant, parameters)


def test_every_group_has_a_stiffness(joints: JointMap) -> None:
    assert {group_of(name) for name in joints.names} == set(STIFFNESS_BY_GROUP)
