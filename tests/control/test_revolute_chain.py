"""A chain of hinges is where Drake says it is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    JacobianWrtVariable,
    PrismaticJoint,
    RevoluteJoint,
    SpatialInertia,
)

from humanwalk.body import LEG_JOINTS, SIDES
from humanwalk.body.plant import Subject, kinematics_plant
from humanwalk.control.revolute_chain import RevoluteChain, pose_of

PLANT = kinematics_plant(Subject())
CHAINS = {side: RevoluteChain.of(PLANT, "Pelvis", f"{side}Leg_Sole", LEG_JOINTS[side]) for side in SIDES}


@given(side=st.sampled_from(SIDES), theta=st.lists(st.floats(-3.2, 3.2), min_size=7, max_size=7))
def test_pose_and_jacobian_are_drakes(side, theta):
    context = PLANT.CreateDefaultContext()
    joints = [PLANT.GetJointByName(name) for name in LEG_JOINTS[side]]
    for joint, angle in zip(joints, theta, strict=True):
        joint.set_angle(context, angle)
    P, S = PLANT.GetFrameByName("Pelvis"), PLANT.GetFrameByName(f"{side}Leg_Sole")
    J = PLANT.CalcJacobianSpatialVelocity(context, JacobianWrtVariable.kV, S, np.zeros(3), P, P)
    found = CHAINS[side].at(theta)
    np.testing.assert_allclose(np.array(found.X_PS).T, S.CalcPose(context, P).GetAsMatrix34(), atol=1e-14)
    np.testing.assert_allclose(found.jacobian(), J[:, [joint.velocity_start() for joint in joints]], atol=1e-14)


@given(
    roll_pitch_yaw=st.tuples(*[st.floats(-3.2, 3.2)] * 3),
    origin=st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    length=st.floats(0.5, 2.0),
)
def test_a_pose_of_a_quaternion_is_drakes_whatever_its_length(roll_pitch_yaw, origin, length):
    X = RigidTransform(RollPitchYaw(roll_pitch_yaw), origin)
    found = pose_of(length * X.rotation().ToQuaternion().wxyz(), origin)
    np.testing.assert_allclose(np.array(found).T, X.GetAsMatrix34(), atol=1e-14)


def plant_with(make_joint):
    """World, a body on a joint, and a frame `tip` on it."""
    plant = MultibodyPlant(0.0)
    body = plant.AddRigidBody("body", SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    plant.AddJoint(make_joint(plant.world_frame(), body.body_frame()))
    plant.AddFrame(FixedOffsetFrame("tip", body.body_frame(), RigidTransform([0.0, 0.0, -1.0])))
    plant.AddFrame(FixedOffsetFrame("turned", body.body_frame(), RigidTransform(RollPitchYaw(0.1, 0, 0), [0, 0, 0])))
    plant.Finalize()
    return plant


def test_a_hinge_about_a_slanting_axis_is_refused():
    plant = plant_with(lambda parent, child: RevoluteJoint("hinge", parent, child, [0.6, 0.8, 0.0]))
    with pytest.raises(ValueError, match="hinge: turns about"):
        RevoluteChain.of(plant, "world", "tip", ["hinge"])


def test_a_slide_is_refused():
    plant = plant_with(lambda parent, child: PrismaticJoint("slide", parent, child, [1.0, 0.0, 0.0]))
    with pytest.raises(ValueError, match="slide: no hinge"):
        RevoluteChain.of(plant, "world", "tip", ["slide"])


def test_a_turned_tip_is_refused():
    plant = plant_with(lambda parent, child: RevoluteJoint("hinge", parent, child, [0.0, -1.0, 0.0]))
    with pytest.raises(ValueError, match="turned: turned in world"):
        RevoluteChain.of(plant, "world", "turned", ["hinge"])
    assert RevoluteChain.of(plant, "world", "tip", ["hinge"]).hinges[0].sign == -1.0
