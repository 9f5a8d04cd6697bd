"""Joint map: the places of the joints in a state are those that the plant itself uses."""

import numpy as np
import pytest
from pydrake.common.eigen_geometry import Quaternion
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body import human
from humanwalk.body.impairments import StiffKnee
from humanwalk.body.joint_map import MAX_PLAY, JointMap, pelvis_pose, pelvis_velocity
from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.body.plant import body_plant
from humanwalk.body.subject import Subject


def test_it_lists_every_joint_of_the_body_in_the_model_files_order(joints: JointMap) -> None:
    assert joints.names == tuple(joint.name for joint in human().joints)
    assert len(joints.names) == 42


def test_positions_and_velocities_are_the_plants_own(plant: MultibodyPlant, joints: JointMap) -> None:
    context = plant.CreateDefaultContext()
    rng = np.random.default_rng(0)
    q, v = rng.normal(size=len(joints.names)), rng.normal(size=len(joints.names))
    for name, angle, rate in zip(joints.names, q, v, strict=True):
        joint = plant.GetJointByName(name)
        joint.set_angle(context, angle)
        joint.set_angular_rate(context, rate)
    state = plant.GetPositionsAndVelocities(context)
    np.testing.assert_array_equal(joints.positions(state), q)
    np.testing.assert_array_equal(joints.positions(state[: joints.num_positions]), q)
    np.testing.assert_array_equal(joints.velocities(state), v)


def test_pose_and_velocity_of_the_pelvis_are_the_plants_own(plant: MultibodyPlant) -> None:
    context, pelvis = plant.CreateDefaultContext(), plant.GetBodyByName(PELVIS)
    X_WP = RigidTransform(Quaternion(0.8, 0.0, 0.6, 0.0), [1.0, 2.0, 3.0])
    velocity = np.arange(1.0, 7.0)
    plant.SetFreeBodyPose(context, pelvis, X_WP)
    plant.SetFreeBodySpatialVelocity(context, pelvis, SpatialVelocity(velocity))
    q, v = plant.GetPositions(context), plant.GetVelocities(context)
    np.testing.assert_allclose(q[pelvis_pose(plant)], [0.8, 0.0, 0.6, 0.0, 1.0, 2.0, 3.0], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(v[pelvis_velocity(plant)], velocity)


@pytest.mark.parametrize("angle", [0.05, 0.1745, 0.3, 0.5, 0.7])
def test_a_knee_with_the_largest_play_of_a_lock_is_locked_at_every_angle(angle: float) -> None:
    joints = JointMap.of(body_plant(Subject(impairments=(StiffKnee(angle, 0.5 * MAX_PLAY),))))
    assert joints.locked[joints.names.index(LEGS["Right"].knee)]


def test_actuators_act_on_the_joints_in_the_maps_order(plant: MultibodyPlant, joints: JointMap) -> None:
    selection = plant.MakeActuationMatrix()
    np.testing.assert_array_equal(selection[joints.v], np.eye(len(joints.names)))


def test_order_of_joints_and_order_of_state_differ(joints: JointMap) -> None:
    assert not np.all(np.diff(joints.q) > 0)


def test_limits_are_the_skeletons(joints: JointMap) -> None:
    for i, name in enumerate(joints.names):
        joint = human().joint(name)
        np.testing.assert_allclose((joints.lower[i], joints.upper[i]), joint.range_rad, rtol=1e-9)
        np.testing.assert_allclose(joints.effort_limits[i], joint.effort_limit_N_m, rtol=1e-9)
