"""Foot force observer: in quiet standing the feet carry the weight within their soles."""

import dataclasses

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body.contact import SOLE_PARTS
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.skeleton import Skeleton
from humanwalk.choices.actuation import PdActuation
from humanwalk.choices.contact import CONTACTS
from humanwalk.diagrams.world import add_world
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.scenario import Scenario, SimulationParameters
from humanwalk.systems.foot_force_observer import FootForceObserver
from humanwalk.terrain import Plane

N = 42
SCENARIO = Scenario(simulation=SimulationParameters(time_step=0.002), actuation=PdActuation(law="implicit"))


def standing(
    contact: str, lift: float = 0.0, duration: float = 1.0
) -> tuple[Array, float, list[RigidTransform], Array]:
    """Feet (2, 8) of the stiff human some time after neutral standing, weight, poses of the soles, velocities."""
    builder = DiagramBuilder()
    human = add_world(builder, dataclasses.replace(SCENARIO, contact=CONTACTS[contact]()))
    plant = human.plant
    observer = builder.GetSubsystemByName("foot_contact")
    desired = builder.AddSystem(ConstantVectorSource(np.zeros(2 * N)))
    builder.Connect(desired.get_output_port(), plant.get_desired_state_input_port(human.instance))
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    pelvis = plant.GetBodyByName("Pelvis")
    q = kinematics_plant(SCENARIO.subject).GetDefaultPositions()
    q[pelvis.floating_positions_start() + 6] += lift
    plant.SetPositions(context, q)
    simulator.AdvanceTo(duration)
    forces = observer.GetOutputPort("foot_forces").Eval(observer.GetMyContextFromRoot(simulator.get_context()))
    soles = [plant.GetFrameByName(leg.sole).CalcPoseInWorld(context) for leg in LEGS.values()]
    return forces.reshape(2, 8), plant.CalcTotalMass(context) * GRAVITY, soles, plant.GetVelocities(context)


@pytest.fixture(scope="module", params=["point", "hydroelastic"])
def stood(request: pytest.FixtureRequest) -> tuple[Array, float, list[RigidTransform], Array]:
    return standing(request.param)


def test_ports(plant: MultibodyPlant) -> None:
    builder = DiagramBuilder()
    human = add_world(builder, SCENARIO)
    observer = FootForceObserver(human.plant, human.scene_graph.model_inspector(), Plane())
    assert observer.num_input_ports() == 1
    assert observer.GetInputPort("contact_results").get_name() == "contact_results"
    port = observer.GetOutputPort("foot_forces")
    assert (port.get_name(), port.size()) == ("foot_forces", 16)
    use = observer.GetOutputPort("friction_use")
    assert (use.get_name(), use.size()) == ("friction_use", 2)
    context = observer.CreateDefaultContext()
    observer.GetInputPort("contact_results").FixValue(context, Value(ContactResults()))
    np.testing.assert_array_equal(port.Eval(context), 0.0)
    np.testing.assert_array_equal(use.Eval(context), 0.0)


def test_the_feet_carry_the_weight(stood: tuple[Array, float, list[RigidTransform], Array]) -> None:
    feet, weight, _, velocities = stood
    assert np.abs(velocities).max() < 0.05
    assert feet[:, 2].sum() == pytest.approx(weight, rel=0.01)
    np.testing.assert_array_equal(feet[:, 7], 1.0)


def test_a_symmetric_body_loads_both_feet_alike(stood: tuple[Array, float, list[RigidTransform], Array]) -> None:
    feet, weight, _, _ = stood
    right, left = feet
    assert right[2] == pytest.approx(left[2], rel=0.01)
    assert right[1] == pytest.approx(-left[1], abs=0.01 * weight)
    assert right[3] == pytest.approx(left[3], abs=0.002)
    assert right[4] == pytest.approx(-left[4], abs=0.002)


def test_the_center_of_pressure_lies_within_each_sole(stood: tuple[Array, float, list[RigidTransform], Array]) -> None:
    feet, _, soles, _ = stood
    back, front = SOLE_PARTS[0].x[0], SOLE_PARTS[-1].x[1]
    half_width = max(part.width for part in SOLE_PARTS) / 2
    for foot, X_WS in zip(feet, soles, strict=True):
        x, y, _ = X_WS.inverse().multiply(foot[3:6])
        assert back < x < front
        assert abs(y) < half_width
        assert foot[5] == pytest.approx(0.0, abs=1e-12)


def test_the_centers_of_pressure_balance_the_body(
    stood: tuple[Array, float, list[RigidTransform], Array], skeleton: Skeleton
) -> None:
    """At rest the weight's line of action goes through their mean."""
    feet, _, _, _ = stood
    middle = np.average(feet[:, 3:5], axis=0, weights=feet[:, 2])
    np.testing.assert_allclose(middle, skeleton.com[:2], atol=0.01)


@pytest.mark.parametrize("contact", ["point", "hydroelastic"])
def test_in_the_air_everything_is_zero(contact: str) -> None:
    feet, *_ = standing(contact, lift=0.3, duration=0.01)
    np.testing.assert_array_equal(feet, 0.0)


def test_its_signals_are_recorded_under_the_names_of_the_feet() -> None:
    world = add_world(DiagramBuilder(), SCENARIO)
    forces, friction_use = FootForceObserver(world.plant, world.scene_graph.model_inspector(), Plane()).signals
    assert forces.columns[:3] == tuple(f"right_foot.force_{axis}_N" for axis in "xyz")
    assert forces.columns[8:11] == tuple(f"left_foot.force_{axis}_N" for axis in "xyz")
    assert friction_use.columns == ("right_foot.friction_use", "left_foot.friction_use")
