"""The balanced walker stays up by itself, with no force on it but the ground's, and refuses what it cannot do."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.diagrams.walker import make_diagram
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario, parse_scenario
from humanwalk.systems.push_source import PushSource

PORTS = {
    *("state", "net_actuation", "contact_results", "query_object", "torque", "saturated", "desired_state", "phase"),
    *("contact_schedule", "soles", "com", "foot_forces", "friction_use", "command", "balance", "qp_status", "push"),
    *("felt_load", "leg_contact"),
}


def test_it_exports_what_a_run_records() -> None:
    diagram = make_diagram(load_scenario("stand"))
    assert {diagram.get_output_port(i).get_name() for i in range(diagram.num_output_ports())} == PORTS
    assert diagram.num_input_ports() == 0


def test_nothing_but_the_ground_acts_on_it() -> None:
    diagram = make_diagram(load_scenario("walk"))
    assert not diagram.HasSubsystemNamed("support")
    plant = diagram.GetSubsystemByName("plant")
    simulator = Simulator(diagram)
    simulator.Initialize()
    context = plant.GetMyContextFromRoot(simulator.get_context())
    assert not plant.get_applied_spatial_force_input_port().Eval(context)
    assert not plant.get_applied_generalized_force_input_port().HasValue(context)


def test_who_is_to_be_pushed_has_a_source_of_pushes() -> None:
    push = "[{time: 0.0, duration: 0.1, impulse: 10.0}]"
    diagram = make_diagram(load_scenario("walk", {"pushes.given": push}))
    plant, source = diagram.GetSubsystemByName("plant"), diagram.GetSubsystemByName("pushes")
    assert isinstance(source, PushSource)
    context = diagram.CreateDefaultContext()
    (force,) = plant.get_applied_spatial_force_input_port().Eval(plant.GetMyContextFromRoot(context))
    assert force.F_Bq_W.translational() == pytest.approx([100.0, 0.0, 0.0])
    assert diagram.GetOutputPort("push").Eval(context) == pytest.approx([100.0, 0.0, 0.0])


GROUNDS = [
    {"contact": "point"},
    {"contact": "hydroelastic"},
    {"contact": "asperity", "simulation.time_step": "0.001"},
]


@pytest.mark.slow
@pytest.mark.parametrize("ground", GROUNDS, ids=lambda ground: ground["contact"])
def test_it_stands_on_every_ground(ground: dict[str, str]) -> None:
    """The center of mass moves to its place ahead of the ankles, which are below the origin."""
    scenario = load_scenario("stand", ground)
    ahead = scenario.controller.fitted(scenario.subject).planner.support.center  # type: ignore[attr-defined]
    diagram = make_diagram(scenario)
    simulator = Simulator(diagram)
    context = simulator.get_context()
    start = diagram.GetOutputPort("com").Eval(context).copy()
    simulator.AdvanceTo(2.0)
    com = diagram.GetOutputPort("com").Eval(context)
    np.testing.assert_allclose(com[:2], (ahead, start[1]), atol=0.01)
    assert com[2] == pytest.approx(start[2], abs=0.03)
    weight = diagram.GetOutputPort("foot_forces").Eval(context)[[2, 10]].sum()
    assert weight == pytest.approx(70.0 * 9.81, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("ground", GROUNDS, ids=lambda ground: ground["contact"])
def test_it_walks_its_first_steps(ground: dict[str, str]) -> None:
    command = {"controller.balanced.command.points": "[{time: 0.2, forward: 0.6}]"}
    diagram = make_diagram(load_scenario("walk", command | ground))
    simulator = Simulator(diagram)
    context = simulator.get_context()
    start = diagram.GetOutputPort("com").Eval(context).copy()
    simulator.AdvanceTo(3.5)
    com = diagram.GetOutputPort("com").Eval(context)
    assert com[2] > 0.9 * start[2]
    assert com[0] - start[0] > 0.5
    assert abs(com[1]) < 0.1
    assert np.abs(diagram.GetOutputPort("push").Eval(context)).max() == 0.0
    assert diagram.GetOutputPort("qp_status").Eval(context)[1] == 0


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bits() -> None:
    ends = []
    for _ in range(2):
        diagram = make_diagram(load_scenario("walk", {"seed": "3", "simulation.time_step": "0.002"}))
        simulator = Simulator(diagram)
        simulator.AdvanceTo(2.5)
        ends.append(diagram.GetOutputPort("state").Eval(simulator.get_context()).tobytes())
    assert ends[0] == ends[1]


def test_a_continuous_plant_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"allowed: simulation.integrator: discrete"):
        make_diagram(load_scenario("walk", {"simulation.integrator": "cenic", "simulation.time_step": "0"}))


def test_the_default_controller_is_the_thesis() -> None:
    assert make_diagram(parse_scenario("")).HasSubsystemNamed("inverse_kinematics")
