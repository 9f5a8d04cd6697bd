"""Playback state: pelvis and joints at their places in the plant's state."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap
from humanwalk.systems.playback_state import PlaybackState

ANGLES = np.linspace(-0.3, 0.3, 42)
RATES = np.linspace(1.0, 2.0, 42)
X_WP = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [1.0, 2.0, 3.0])
V_WP = SpatialVelocity([0.4, 0.5, 0.6], [0.7, 0.8, 0.9])


@pytest.fixture
def system(plant: MultibodyPlant) -> PlaybackState:
    return PlaybackState(plant)


def test_ports(system: PlaybackState) -> None:
    inputs = [system.get_input_port(i) for i in range(system.num_input_ports())]
    assert [(port.get_name(), port.size()) for port in inputs] == [("pelvis_reference", 13), ("desired_state", 84)]
    (output,) = [system.get_output_port(i) for i in range(system.num_output_ports())]
    assert (output.get_name(), output.size()) == ("state", 97)


def test_state_is_the_reference(system: PlaybackState, plant: MultibodyPlant, joints: JointMap) -> None:
    context = system.CreateDefaultContext()
    reference = (X_WP.rotation().ToQuaternion().wxyz(), X_WP.translation(), V_WP.get_coeffs())
    system.GetInputPort("pelvis_reference").FixValue(context, np.concatenate(reference))
    system.GetInputPort("desired_state").FixValue(context, np.concatenate((ANGLES, RATES)))
    body = plant.CreateDefaultContext()
    plant.SetPositionsAndVelocities(body, system.GetOutputPort("state").Eval(context))
    pelvis = plant.GetBodyByName("Pelvis")
    assert pelvis.EvalPoseInWorld(body).IsNearlyEqualTo(X_WP, 1e-12)
    np.testing.assert_allclose(pelvis.EvalSpatialVelocityInWorld(body).get_coeffs(), V_WP.get_coeffs(), atol=1e-12)
    for i, name in enumerate(joints.names):
        joint = plant.GetJointByName(name)
        assert (joint.get_angle(body), joint.get_angular_rate(body)) == pytest.approx((ANGLES[i], RATES[i]))


def test_unconnected_input_is_refused(system: PlaybackState) -> None:
    with pytest.raises(RuntimeError, match="pelvis_reference"):
        system.GetOutputPort("state").Eval(system.CreateDefaultContext())
