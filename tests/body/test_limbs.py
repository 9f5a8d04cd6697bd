"""Limbs: every name is one of the model, every joint belongs to one group."""

import pytest
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body import SIDES, human
from humanwalk.body.limbs import ARMS, CHEST, HEAD, JOINT_GROUPS, LEGS, PELVIS, group_of
from humanwalk.sides import Side


def test_every_joint_of_the_body_is_in_one_group() -> None:
    grouped = [joint for joints in JOINT_GROUPS.values() for joint in joints]
    assert sorted(grouped) == sorted(joint.name for joint in human().joints)
    assert all(joint in JOINT_GROUPS[group_of(joint)] for joint in grouped)


@pytest.mark.parametrize("side", SIDES)
def test_a_legs_chain_leads_from_the_pelvis_to_the_hindfoot(side: Side) -> None:
    skeleton, leg = human(), LEGS[side]
    body = PELVIS
    for name in leg.chain:
        joint = skeleton.joint(name)
        assert joint.parent == body
        body = joint.child
    assert body == leg.hindfoot


def test_bodies_are_of_the_model(plant: MultibodyPlant) -> None:
    for leg in LEGS.values():
        assert all(plant.HasBodyNamed(body) for body in (leg.thigh, leg.shank, *leg.foot_bodies))
        assert plant.HasFrameNamed(leg.sole)
    assert all(plant.HasBodyNamed(body) for body in (PELVIS, CHEST, HEAD))


def test_arm_joints_move_in_the_direction_of_their_names() -> None:
    for arm in ARMS.values():
        assert "elbow" in human().joint(arm.elbow).motion
        assert all("shoulder" in human().joint(name).motion for name in arm.shoulder)
