"""The gait planner as a system: ports, its update, and that reading a port plans nothing."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.control.step_planner import StepPlannerParameters
from humanwalk.control.walking_reference import Phase
from humanwalk.systems.gait_planner import GaitPlanner, Plan

PERIOD = 0.004


@pytest.fixture
def planner(plant):
    return GaitPlanner(plant, StepPlannerParameters(), "Right", PERIOD)


def simulator_of(planner, plant, command):
    simulator = Simulator(planner)
    context = simulator.get_mutable_context()
    planner.get_state_input_port().FixValue(context, plant.GetPositionsAndVelocities(plant.CreateDefaultContext()))
    planner.get_foot_forces_input_port().FixValue(context, np.zeros(16))
    planner.get_command_input_port().FixValue(context, np.array(command, dtype=float))
    simulator.Initialize()
    return simulator


def test_ports(planner, plant):
    inputs = [planner.get_input_port(i) for i in range(planner.num_input_ports())]
    assert [(port.get_name(), port.size()) for port in inputs] == [
        ("state", plant.num_multibody_states()),
        ("foot_forces", 16),
        ("command", 3),
    ]
    outputs = [planner.get_output_port(i) for i in range(planner.num_output_ports())]
    assert [port.get_name() for port in outputs] == ["plan", "phase", "contact_schedule", "balance"]
    assert [port.size() for port in outputs[1:]] == [2, 2, 9]


def test_before_it_is_initialised_it_has_no_plan_and_both_feet_stand(planner):
    context = planner.CreateDefaultContext()
    assert planner.get_plan_output_port().Eval(context) == Plan()
    assert planner.get_contact_schedule_output_port().Eval(context) == pytest.approx([1, 1])
    assert planner.get_balance_output_port().Eval(context) == pytest.approx(np.zeros(9))


def test_it_stands_until_it_is_told_to_walk(planner, plant):
    simulator = simulator_of(planner, plant, (0, 0, 0))
    simulator.AdvanceTo(0.5)
    plan = planner.get_plan_output_port().Eval(simulator.get_context())
    assert plan.reference.phase is Phase.STAND
    assert planner.get_phase_output_port().Eval(simulator.get_context()) == pytest.approx([0, 0])


def test_a_command_makes_it_shift_the_weight_and_lift_the_first_foot(planner, plant):
    simulator = simulator_of(planner, plant, (0.3, 0, 0))
    simulator.AdvanceTo(0.5)
    assert planner.get_plan_output_port().Eval(simulator.get_context()).reference.phase is Phase.WEIGHT_SHIFT
    simulator.AdvanceTo(1.2)
    context = simulator.get_context()
    assert planner.get_plan_output_port().Eval(context).reference.phase is Phase.SINGLE_SUPPORT
    assert planner.get_contact_schedule_output_port().Eval(context) == pytest.approx([0, 1])


def test_reading_plans_nothing(planner, plant):
    simulator = simulator_of(planner, plant, (0.3, 0, 0))
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    first = planner.get_plan_output_port().Eval(context)
    planner.get_balance_output_port().Eval(context)
    assert planner.get_plan_output_port().Eval(context).state is first.state
