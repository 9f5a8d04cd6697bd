"""Foot force observer: in quiet standing the feet carry the weight within their soles."""

import dataclasses
from typing import NamedTuple

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


class Stood(NamedTuple):
    """The stiff human some time after neutral standing.

    Attributes:
        feet: Output foot_forces, shape (2, 8).
        weight: [N].
        soles: Their poses.
        velocities: Of the plant.
        moment: Of all contact forces about the origin of W, as they move the plant [N m], shape (3,).
    """

    feet: Array
    weight: float
    soles: list[RigidTransform]
    velocities: Array
    moment: Array


def standing(contact: str, lift: float = 0.0, duration: float = 1.0) -> Stood:
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
    moment, force = plant.get_generalized_contact_forces_output_port(human.instance).Eval(context)[:6].reshape(2, 3)
    moment = moment + np.cross(pelvis.EvalPoseInWorld(context).translation(), force)
    weight = plant.CalcTotalMass(context) * GRAVITY
    return Stood(forces.reshape(2, 8), weight, soles, plant.GetVelocities(context), moment)


@pytest.fixture(scope="module", params=["point", "hydroelastic"])
def stood(request: pytest.FixtureRequest) -> Stood:
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


def test_the_feet_carry_the_weight(stood: Stood) -> None:
    assert np.abs(stood.velocities).max() < 0.05
    assert stood.feet[:, 2].sum() == pytest.approx(stood.weight, rel=0.01)
    np.testing.assert_array_equal(stood.feet[:, 7], 1.0)


def test_a_symmetric_body_loads_both_feet_alike(stood: Stood) -> None:
    right, left = stood.feet
    assert right[2] == pytest.approx(left[2], rel=0.01)
    assert right[1] == pytest.approx(-left[1], abs=0.01 * stood.weight)
    assert right[3] == pytest.approx(left[3], abs=0.002)
    assert right[4] == pytest.approx(-left[4], abs=0.002)


def test_the_center_of_pressure_lies_within_each_sole(stood: Stood) -> None:
    back, front = SOLE_PARTS[0].x[0], SOLE_PARTS[-1].x[1]
    half_width = max(part.width for part in SOLE_PARTS) / 2
    for foot, X_WS in zip(stood.feet, stood.soles, strict=True):
        x, y, _ = X_WS.inverse().multiply(foot[3:6])
        assert back < x < front
        assert abs(y) < half_width
        assert foot[5] == pytest.approx(0.0, abs=1e-12)


def test_the_centers_of_pressure_balance_the_body(stood: Stood, skeleton: Skeleton) -> None:
    """At rest the weight's line of action goes through their mean."""
    middle = np.average(stood.feet[:, 3:5], axis=0, weights=stood.feet[:, 2])
    np.testing.assert_allclose(middle, skeleton.com[:2], atol=0.01)


def test_forces_and_free_moments_at_the_centers_of_pressure_have_the_moment_of_the_contact(stood: Stood) -> None:
    moment = np.cross(stood.feet[:, 3:6], stood.feet[:, :3]).sum(axis=0)
    moment[2] += stood.feet[:, 6].sum()
    # The forces are those of the last step, in which the pelvis moved by less than 10 um.
    np.testing.assert_allclose(moment, stood.moment, atol=1e-5 * stood.weight)


@pytest.mark.parametrize("contact", ["point", "hydroelastic"])
def test_in_the_air_everything_is_zero(contact: str) -> None:
    np.testing.assert_array_equal(standing(contact, lift=0.3, duration=0.01).feet, 0.0)


def test_its_signals_are_recorded_under_the_names_of_the_feet() -> None:
    world = add_world(DiagramBuilder(), SCENARIO)
    forces, friction_use = FootForceObserver(world.plant, world.scene_graph.model_inspector(), Plane()).signals
    assert forces.columns[:3] == tuple(f"right_foot.force_{axis}_N" for axis in "xyz")
    assert forces.columns[8:11] == tuple(f"left_foot.force_{axis}_N" for axis in "xyz")
    assert friction_use.columns == ("right_foot.friction_use", "left_foot.friction_use")
