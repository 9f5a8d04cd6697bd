"""Impairments: joint ranges, strength, passive stiffness and lengths of a healthy skeleton."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.tree import ForceElementIndex, RevoluteSpring

from humanwalk.body import Skeleton, human
from humanwalk.body.impairments import (
    IMPAIRMENTS,
    HipContracture,
    JointImpairment,
    ShortLeg,
    StiffKnee,
    WeakPlantarflexors,
)
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import body_plant, kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.quantity import ParameterError

PEOPLE = {
    "thesis": Subject(sex="unspecified"),
    "woman": Subject(60.0, 1.65, "female"),
    "child": Subject(20.0, 1.10, "male", 6.0),
}


def changed_joints(skeleton: Skeleton) -> set[str]:
    return {new.name for new, old in zip(skeleton.joints, human().joints, strict=True) if new != old}


@pytest.mark.parametrize("kind", IMPAIRMENTS)
@pytest.mark.parametrize("person", PEOPLE)
def test_an_impaired_body_has_the_joints_of_the_healthy_one(kind: str, person: str) -> None:
    subject = dataclasses.replace(PEOPLE[person], impairments=(IMPAIRMENTS[kind](),))
    impaired, healthy = JointMap.of(body_plant(subject)), JointMap.of(body_plant(PEOPLE[person]))
    assert impaired.names == healthy.names
    assert (impaired.lower >= healthy.lower).all()
    assert (impaired.upper <= healthy.upper).all()
    assert (impaired.effort_limits <= healthy.effort_limits).all()
    assert kind.replace("_", " ") in str(subject)


def test_a_stiff_knee_is_locked_at_its_angle() -> None:
    subject = Subject(impairments=(StiffKnee(side="Left"),))
    joints = JointMap.of(body_plant(subject))
    assert [joints.names[i] for i in np.flatnonzero(joints.locked)] == [LEGS["Left"].knee]
    assert math.radians(10.0) == pytest.approx(joints.lower[joints.locked][0], abs=0.001)
    assert not JointMap.of(body_plant(Subject(impairments=(StiffKnee(play=0.1),)))).locked.any()


def test_weak_plantarflexors_have_their_share_of_the_strength() -> None:
    weak = WeakPlantarflexors(0.5).applied(human())
    assert changed_joints(weak) == {leg.ankle for leg in LEGS.values()}
    for leg in LEGS.values():
        assert weak.joint(leg.ankle).effort_limit_N_m == 0.5 * human().joint(leg.ankle).effort_limit_N_m


def test_a_contracture_ends_the_range_and_pulls_toward_its_rest_angle() -> None:
    subject = Subject(impairments=(HipContracture(0.2, stiffness=30.0, rest_angle=0.4),))
    joint = subject.skeleton.joint(LEGS["Right"].hip_flexion)
    assert (joint.range_rad[0], joint.stiffness, joint.rest_angle) == (0.2, 30.0, 0.4)
    plant = body_plant(subject)
    elements = [plant.get_force_element(ForceElementIndex(i)) for i in range(plant.num_force_elements())]
    (spring,) = [element for element in elements if isinstance(element, RevoluteSpring)]
    assert spring.joint().name() == joint.name
    assert (spring.default_stiffness(), spring.default_nominal_angle()) == (30.0, 0.4)


@given(
    stiffness=st.tuples(st.floats(0.0, 100.0), st.floats(0.0, 100.0)),
    rest=st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)),
    angle=st.floats(-1.0, 1.0),
)
def test_springs_on_one_joint_add_up(stiffness: tuple[float, float], rest: tuple[float, float], angle: float) -> None:
    skeleton = human()
    for k, q in zip(stiffness, rest, strict=True):
        skeleton = JointImpairment("elbow", "Left", stiffness=k, rest_angle=q).applied(skeleton)
    joint = skeleton.joint("LeftArmElbowMotion")
    torque = sum(k * (q - angle) for k, q in zip(stiffness, rest, strict=True))
    assert joint.stiffness * (joint.rest_angle - angle) == pytest.approx(torque, abs=1e-9)


@pytest.mark.parametrize("person", PEOPLE)
@given(shortening=st.floats(0.001, 0.06))
def test_the_shorter_leg_ends_above_the_ground_and_the_rest_stays(person: str, shortening: float) -> None:
    healthy = PEOPLE[person].skeleton
    short = ShortLeg(shortening, "Left").applied(healthy)
    assert short.raised == pytest.approx((0.0, shortening))
    assert short.leg_length == pytest.approx(healthy.leg_length - shortening)
    assert short.stature == healthy.stature
    left = LEGS["Left"]
    for body in (left.hindfoot, left.forefoot, left.toe_segment):
        assert short.origins[body] - healthy.origins[body] == pytest.approx([0.0, 0.0, shortening])
    assert short.ankle_height("Left") == pytest.approx(healthy.ankle_height("Left"))
    share = short.segment(left.shank).mass / healthy.segment(left.shank).mass
    assert share == pytest.approx(1.0 - shortening / -healthy.joint(left.ankle).origin[2])


def test_center_and_radii_of_gyration_of_a_shorter_shank_are_in_proportion_to_its_length() -> None:
    """But not the radius about its length."""
    shank, shortening = LEGS["Left"].shank, 0.05
    healthy, short = human().segment(shank), ShortLeg(shortening, "Left").applied(human()).segment(shank)
    ratio = 1.0 - shortening / -human().joint(LEGS["Left"].ankle).origin[2]
    np.testing.assert_allclose(short.inertia / short.mass, healthy.inertia / healthy.mass * (ratio**2, ratio**2, 1.0))
    np.testing.assert_allclose(short.com, np.multiply(healthy.com, (1.0, 1.0, ratio)))


def test_two_short_legs_stand_on_the_ground() -> None:
    short = ShortLeg(0.03, "Left").applied(ShortLeg(0.02, "Right").applied(human()))
    assert short.raised == pytest.approx((0.0, 0.01))
    assert short.root_height == pytest.approx(human().root_height - 0.02)
    assert short.origins["RightLeg_Ankle"] == pytest.approx(human().origins["RightLeg_Ankle"])


def test_the_walkers_model_lacks_an_unknown_impairment() -> None:
    subject = Subject(impairments=(WeakPlantarflexors(known=False),))
    assert subject.known_skeleton == Subject().skeleton != subject.skeleton
    assert (
        JointMap.of(kinematics_plant(subject)).effort_limits.sum()
        > JointMap.of(body_plant(subject)).effort_limits.sum()
    )


def test_what_a_body_cannot_have_is_refused_in_one_line() -> None:
    with pytest.raises(ParameterError, match=r"^subject\.joint\.lower: .*allowed: .*change"):
        _ = Subject(impairments=(JointImpairment("knee", lower=1.0, upper=0.5),)).skeleton
    with pytest.raises(ParameterError, match=r"^subject\.short_leg\.shortening: .*half"):
        _ = Subject(12.0, 1.0, "male", 6.0, impairments=(ShortLeg(0.12),) * 2).skeleton
