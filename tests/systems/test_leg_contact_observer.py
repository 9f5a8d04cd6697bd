"""The force between the legs: zero while they are apart, whatever the ground does."""

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, Diagram

from humanwalk.body.limbs import LEGS, PELVIS
from humanwalk.diagrams.walker import make_diagram
from humanwalk.scenario import load_scenario


@pytest.fixture(scope="module")
def walker() -> Diagram:
    return make_diagram(load_scenario("stand"))


def stepped(walker: Diagram, adduction: float, height: float) -> tuple[MultibodyPlant, Context]:
    """The plant and the context after one step of a body that is lifted, with adducted legs."""
    plant = walker.GetSubsystemByName("plant")
    simulator = Simulator(walker)
    context = simulator.get_mutable_context()
    of_plant = plant.GetMyMutableContextFromRoot(context)
    for leg in LEGS.values():
        plant.GetJointByName(leg.hip_abduction).set_angle(of_plant, -adduction)
    pelvis = plant.GetBodyByName(PELVIS)
    pose = plant.GetFreeBodyPose(of_plant, pelvis)
    pose.set_translation(pose.translation() + height * np.eye(3)[2])
    plant.SetFreeBodyPose(of_plant, pelvis, pose)
    simulator.AdvanceTo(plant.time_step())
    return plant, context


def force(walker: Diagram, adduction: float, height: float) -> float:
    """Force between the legs [N]."""
    (value,) = walker.GetOutputPort("leg_contact").Eval(stepped(walker, adduction, height)[1])
    return float(value)


@pytest.mark.parametrize("height", [0.0, 0.5, -0.01])
def test_legs_that_are_apart_do_not_push_each_other(walker: Diagram, height: float) -> None:
    assert force(walker, 0.0, height) == 0.0


def test_legs_that_cross_in_the_air_push_each_other_with_all_that_acts_on_one_of_them(walker: Diagram) -> None:
    plant, context = stepped(walker, 0.2, 0.5)
    results, on_left = walker.GetOutputPort("contact_results").Eval(context), np.zeros(3)
    for i in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(i)
        is_left = plant.get_body(info.bodyB_index()).name().startswith("Left")
        on_left += info.contact_force() if is_left else -info.contact_force()
    (value,) = walker.GetOutputPort("leg_contact").Eval(context)
    assert value == pytest.approx(np.linalg.norm(on_left))
    assert value > 0.0


def test_without_leg_contact_there_is_no_such_signal() -> None:
    walker = make_diagram(load_scenario("stand", {"contact.point.leg_contact": "false"}))
    assert not walker.HasOutputPort("leg_contact")


@pytest.mark.parametrize("contact", ["hydroelastic", "asperity"])
def test_every_contact_model_has_it(contact: str) -> None:
    walker = make_diagram(load_scenario("stand", {"contact": contact, "simulation.time_step": "0.001"}))
    assert force(walker, 0.2, 0.5) > 0.0
