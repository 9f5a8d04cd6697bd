"""Balance support as a system: the wrench acts on the pelvis, which yields by force over stiffness."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, MultibodyPlant
from pydrake.multibody.tree import JacobianWrtVariable, SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.control.balance_support import BalanceSupportParameters, support_wrench
from humanwalk.numerics import Array
from humanwalk.systems.balance_support import BalanceSupport

PARAMETERS = BalanceSupportParameters()
X_REFERENCE = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [1.0, 0.5, 0.9])
V_REFERENCE = np.array([0.1, 0.2, 0.3, 1.4, 0.0, -0.1])


def floating_base(X: RigidTransform) -> Array:
    return np.concatenate((X.rotation().ToQuaternion().wxyz(), X.translation()))


REFERENCE = np.concatenate((floating_base(X_REFERENCE), V_REFERENCE))


@pytest.fixture(scope="module")
def support(plant: MultibodyPlant) -> BalanceSupport:
    return BalanceSupport(plant, PARAMETERS)


def context_of(support: BalanceSupport, plant: MultibodyPlant, X_WP: RigidTransform, V_WP: Array) -> Context:
    plant_context = plant.CreateDefaultContext()
    pelvis = plant.GetBodyByName("Pelvis")
    plant.SetFloatingBaseBodyPoseInWorldFrame(plant_context, pelvis, X_WP)
    v = plant.GetVelocities(plant_context)
    start = pelvis.floating_velocities_start_in_v()
    v[start : start + 6] = V_WP
    plant.SetVelocities(plant_context, v)
    context = support.CreateDefaultContext()
    support.GetInputPort("pelvis_reference").FixValue(context, REFERENCE)
    support.GetInputPort("state").FixValue(context, plant.GetPositionsAndVelocities(plant_context))
    return context


def test_ports(support: BalanceSupport, plant: MultibodyPlant) -> None:
    names = [support.get_input_port(i).get_name() for i in range(support.num_input_ports())]
    assert sorted(names) == ["pelvis_reference", "state"]
    assert support.GetInputPort("pelvis_reference").size() == 13
    assert support.GetInputPort("state").size() == plant.num_multibody_states()
    port = support.GetOutputPort("wrench")
    assert (port.get_name(), port.size()) == ("wrench", 6)
    port = support.GetOutputPort("generalized_force")
    assert (port.get_name(), port.size()) == ("generalized_force", plant.num_velocities())


def test_no_wrench_on_the_reference(support: BalanceSupport, plant: MultibodyPlant) -> None:
    context = context_of(support, plant, X_REFERENCE, V_REFERENCE)
    np.testing.assert_allclose(support.GetOutputPort("wrench").Eval(context), 0.0, atol=1e-9)


def test_the_wrench_is_the_law_of_the_pelvis_state(support: BalanceSupport, plant: MultibodyPlant) -> None:
    X_WP = RigidTransform(RollPitchYaw(0.05, 0.25, 0.2), [1.02, 0.49, 0.93])
    V_WP = np.array([0.3, -0.2, 0.1, 1.2, 0.2, 0.0])
    expected = support_wrench(floating_base(X_WP), V_WP, REFERENCE, PARAMETERS)
    context = context_of(support, plant, X_WP, V_WP)
    np.testing.assert_allclose(support.GetOutputPort("wrench").Eval(context), expected, atol=1e-6)


def test_the_generalized_force_is_the_wrench_on_the_pelvis_at_its_origin(
    support: BalanceSupport, plant: MultibodyPlant
) -> None:
    X_WP = RigidTransform(RollPitchYaw(0.3, -0.2, 0.5), [1.1, 0.4, 1.0])
    context = context_of(support, plant, X_WP, np.zeros(6))
    plant_context = plant.CreateDefaultContext()
    pelvis = plant.GetBodyByName("Pelvis")
    plant.SetFloatingBaseBodyPoseInWorldFrame(plant_context, pelvis, X_WP)
    J = plant.CalcJacobianSpatialVelocity(
        plant_context,
        JacobianWrtVariable.kV,
        pelvis.body_frame(),
        np.zeros(3),
        plant.world_frame(),
        plant.world_frame(),
    )
    wrench = support.GetOutputPort("wrench").Eval(context)
    np.testing.assert_allclose(support.GetOutputPort("generalized_force").Eval(context), J.T @ wrench, atol=1e-9)


def test_the_length_of_the_quaternion_does_not_matter(support: BalanceSupport, plant: MultibodyPlant) -> None:
    context = context_of(support, plant, RigidTransform([1.1, 0.4, 1.0]), np.zeros(6))
    expected = support.GetOutputPort("wrench").Eval(context)
    state = support.GetInputPort("state").Eval(context)
    start = plant.GetBodyByName("Pelvis").floating_positions_start()
    state[start : start + 4] *= 1.0001
    support.GetInputPort("state").FixValue(context, state)
    np.testing.assert_allclose(support.GetOutputPort("wrench").Eval(context), expected, atol=1e-6)


def test_in_a_plant_the_pelvis_yields_by_weight_over_stiffness() -> None:
    """The pelvis is a block of the body's mass; its center of mass is off its origin, so that it also rotates."""
    mass, arm = 70.0, 0.02
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.001)
    pelvis = plant.AddRigidBody(
        "Pelvis", SpatialInertia.MakeFromCentralInertia(mass, [arm, 0, 0], mass * UnitInertia.SolidBox(1.0, 1.0, 1.0))
    )
    plant.Finalize()
    support = builder.AddSystem(BalanceSupport(plant, PARAMETERS))
    reference = np.zeros(13)
    reference[0] = 1.0
    source = builder.AddSystem(ConstantVectorSource(reference))
    builder.Connect(source.get_output_port(), support.GetInputPort("pelvis_reference"))
    builder.Connect(plant.get_state_output_port(), support.GetInputPort("state"))
    builder.Connect(support.GetOutputPort("generalized_force"), plant.get_applied_generalized_force_input_port())
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(1.5)
    X_WP = plant.EvalBodyPoseInWorld(plant.GetMyContextFromRoot(simulator.get_context()), pelvis)
    weight = mass * 9.81
    np.testing.assert_allclose(X_WP.translation(), [0, 0, -weight / PARAMETERS.stiffness], atol=1e-7)
    # The weight acts in front of the origin: pitch down, positive about y.
    pitch = weight * arm / PARAMETERS.rotational_stiffness
    np.testing.assert_allclose(X_WP.rotation().matrix(), RotationMatrix.MakeYRotation(pitch).matrix(), atol=1e-6)


def test_the_wrench_is_its_signal(support: BalanceSupport) -> None:
    (signal,) = support.signals
    assert (signal.name, signal.port.get_name()) == ("support_wrench", "wrench")
    assert signal.columns == (
        *(f"support.torque_{axis}_N_m" for axis in "xyz"),
        *(f"support.force_{axis}_N" for axis in "xyz"),
    )
