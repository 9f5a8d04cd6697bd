"""The gait planner as a system: ports, its update, and that reading a port plans nothing."""

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context

from humanwalk.body.contact import SoleExtent
from humanwalk.body.hanging_arm import hanging_arms
from humanwalk.body.subject import Subject
from humanwalk.sides import SIDES, Side, other_side
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.gait_planner import GaitPlanner
from humanwalk.terrain import Plane
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.walking_reference import Phase

PERIOD = 0.004


@pytest.fixture
def planner(plant: MultibodyPlant) -> GaitPlanner:
    sole, arms = SoleExtent(0.055, 0.211, 0.048), hanging_arms(Subject())
    return GaitPlanner(plant, StepPlannerParameters(), "Right", PERIOD, sole, Plane(), arms)


def simulator_of(planner: GaitPlanner, plant: MultibodyPlant, command: tuple[float, ...]) -> Simulator:
    simulator = Simulator(planner)
    context = simulator.get_mutable_context()
    observer = BodyObserver(plant)
    standing = observer.CreateDefaultContext()
    state = plant.GetPositionsAndVelocities(plant.CreateDefaultContext())
    observer.GetInputPort("state").FixValue(standing, state)
    for name in ("com", "ankles"):
        planner.GetInputPort(name).FixValue(context, observer.GetOutputPort(name).Eval(standing))
    planner.GetInputPort("foot_forces").FixValue(context, np.zeros(16))
    planner.GetInputPort("command").FixValue(context, np.array(command, dtype=float))
    simulator.Initialize()
    return simulator


def test_ports(planner: GaitPlanner) -> None:
    inputs = [planner.get_input_port(i) for i in range(planner.num_input_ports())]
    assert [(port.get_name(), port.size()) for port in inputs] == [
        ("com", 6),
        ("ankles", 30),
        ("foot_forces", 16),
        ("command", 3),
        ("load", 4),
    ]
    outputs = [planner.get_output_port(i) for i in range(planner.num_output_ports())]
    assert [port.get_name() for port in outputs] == ["plan", "phase", "contact_schedule", "balance"]
    assert [port.size() for port in outputs[1:]] == [2, 2, 9]


def test_signals_have_a_column_per_element_and_the_names_of_their_ports(planner: GaitPlanner) -> None:
    assert [signal.name for signal in planner.signals] == ["phase", "contact_schedule", "balance"]
    for signal in planner.signals:
        assert signal.port.get_name() == signal.name
        assert len(set(signal.columns)) == signal.port.size()


def test_before_initialization_both_feet_stand(planner: GaitPlanner) -> None:
    context = planner.CreateDefaultContext()
    assert planner.GetOutputPort("contact_schedule").Eval(context) == pytest.approx([1, 1])
    assert planner.GetOutputPort("balance").Eval(context) == pytest.approx(np.zeros(9))


def test_it_stands_while_nothing_is_commanded(planner: GaitPlanner, plant: MultibodyPlant) -> None:
    simulator = simulator_of(planner, plant, (0, 0, 0))
    simulator.AdvanceTo(0.5)
    plan = planner.GetOutputPort("plan").Eval(simulator.get_context())
    assert plan.phase is Phase.STAND
    assert planner.GetOutputPort("phase").Eval(simulator.get_context()) == pytest.approx([0, 0])


def test_a_command_makes_it_shift_the_weight_and_lift_the_first_foot(
    planner: GaitPlanner, plant: MultibodyPlant
) -> None:
    simulator = simulator_of(planner, plant, (0.3, 0, 0))
    simulator.AdvanceTo(0.5)
    assert planner.GetOutputPort("plan").Eval(simulator.get_context()).phase is Phase.WEIGHT_SHIFT
    simulator.AdvanceTo(1.2)
    context = simulator.get_context()
    assert planner.GetOutputPort("plan").Eval(context).phase is Phase.SINGLE_SUPPORT
    assert planner.GetOutputPort("contact_schedule").Eval(context) == pytest.approx([0, 1])


def test_the_gait_cycles_of_the_feet_are_half_a_cycle_apart(planner: GaitPlanner, plant: MultibodyPlant) -> None:
    simulator = simulator_of(planner, plant, (0.3, 0, 0))
    seen = []

    def record(context: Context) -> None:
        right, left = planner.GetOutputPort("phase").Eval(context)
        if planner.GetOutputPort("plan").Eval(context).phase in (Phase.DOUBLE_SUPPORT, Phase.SINGLE_SUPPORT):
            seen.append((right, left))

    simulator.set_monitor(record)
    simulator.AdvanceTo(3.0)
    assert len(seen) > 100
    for right, left in seen:
        assert abs(right - left) == pytest.approx(0.5)
        assert min(right, left) >= 0.0
        assert max(right, left) <= 1.0


def test_evaluating_outputs_does_not_plan(planner: GaitPlanner, plant: MultibodyPlant) -> None:
    simulator = simulator_of(planner, plant, (0.3, 0, 0))
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    first = planner.GetOutputPort("plan").Eval(context)
    planner.GetOutputPort("balance").Eval(context)
    assert planner.GetOutputPort("plan").Eval(context) is first


@pytest.mark.parametrize("side", SIDES)
def test_an_arm_with_a_load_in_its_hand_swings_less(planner: GaitPlanner, plant: MultibodyPlant, side: Side) -> None:
    """The left foot is ahead; the load is felt as far aside as the shoulder."""
    simulator = simulator_of(planner, plant, (0, 0, 0))
    context, arm = simulator.get_mutable_context(), hanging_arms(Subject())[side]
    ankles = planner.GetInputPort("ankles").Eval(context).reshape(2, 5, 3).copy()
    ankles[SIDES.index("Left"), 0, 0] += 0.2
    planner.GetInputPort("ankles").FixValue(context, ankles.ravel())
    planner.GetInputPort("load").FixValue(context, np.array((5.0, 0.0, arm.aside, -0.3)))
    simulator.AdvanceTo(1.5 * PERIOD)
    flexion = planner.GetOutputPort("plan").Eval(context).shoulder_flexion
    swing = {side: abs(angle) for side, (angle, _) in zip(SIDES, flexion, strict=True)}
    assert 0.0 < swing[side] < swing[other_side(side)]
