"""The walker on its own feet as a Diagram: command, step planner, whole-body controller, PD actuators, plant."""

from dataclasses import replace

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body import SIDES
from humanwalk.body.plant import kinematics_plant
from humanwalk.control.gain_noise import noisy_tasks
from humanwalk.diagrams.foot_contact import add_foot_contact, connect_spatial_forces
from humanwalk.diagrams.human_plant import add_human_plant
from humanwalk.diagrams.start import start_positions
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.command_source import CommandSource
from humanwalk.systems.gait_planner import GaitPlanner
from humanwalk.systems.held_actuation import HeldActuation
from humanwalk.systems.pd_actuator_bank import PdActuatorBank
from humanwalk.systems.push_source import PushSource
from humanwalk.systems.whole_body_controller import WholeBodyController

START_FLEXION = 0.12
"""Flexion of hip and ankle at the start, half of the knee's [rad]: a straight leg cannot be shortened."""

TASK_GAINS = 3
"""What their noise is drawn from together with the scenario's seed."""


def make_balanced_walker(scenario: Scenario, visuals: bool = True) -> Diagram:
    """Wire the walker of a scenario that balances by itself; its default context stands at the scenario's start.

    Subsystems by name: plant, scene_graph, command, planner, controller, actuators, held_actuation (with the
    semi-implicit law), pushes (a PushSource where the scenario has any, or zero), body_observer,
    foot_force_observer, or foot_contact with `contact: asperity`.

    Exported outputs, joints in actuator order, named as those of `make_walker`:
        state (97), query_object, contact_results, torque (42), saturated (42), desired_state (84),
        net_actuation (42), phase (2), contact_schedule (2), soles (6), com (6), foot_forces (16), friction_use (2);
    and its own:
        feedforward (42), sample (84), sample_time (1): of the WholeBodyController, for the actuators.
        command (3): see CommandSource.
        balance (9): see GaitPlanner.
        qp_status (3): see WholeBodyController.
        push (3): force of the pushes [N].

    Args:
        scenario: what is simulated.
        visuals: whether there is anything to see; what nobody sees costs, too.

    Raises:
        ParameterError: the scenario's start cannot be reached, or it asks for what this walker cannot do.
    """
    law = scenario.actuators.law
    if scenario.simulation.integrator != "discrete" or law == "explicit":
        raise ParameterError(
            "controller: balanced needs the discrete plant, and actuators that it damps; allowed: "
            "simulation.integrator: discrete with actuators.law: semi_implicit or implicit; set both"
        )
    builder = DiagramBuilder()
    human = add_human_plant(builder, scenario, visuals)
    plant, model = human.plant, kinematics_plant(scenario.subject)
    stance = {
        f"{side}Leg{joint}Motion": times * START_FLEXION
        for side in SIDES
        for joint, times in (("Femur", 1.0), ("Tibia", 2.0), ("Ankle", 1.0))
    }
    start = replace(scenario.start, joint_angles=stance | scenario.start.joint_angles)
    plant.SetDefaultPositions(start_positions(replace(scenario, start=start)))

    walk = scenario.balanced
    command = builder.AddNamedSystem("command", CommandSource(walk.command))
    planner = builder.AddNamedSystem(
        "planner", GaitPlanner(model, walk.planner, scenario.gait.first_swing, walk.control_period)
    )
    posture = {f"{side}ArmElbowMotion": scenario.gait.arms.elbow_flexion for side in SIDES}
    tasks = noisy_tasks(walk.whole_body, scenario.start.gain_noise, np.random.default_rng((scenario.seed, TASK_GAINS)))
    controller = builder.AddNamedSystem(
        "controller",
        WholeBodyController(model, scenario.subject.skeleton, tasks, posture, walk.control_period),
    )
    bank = builder.AddNamedSystem("actuators", PdActuatorBank(plant, human.kp, human.kd, law, human.effort_limits))
    body = builder.AddNamedSystem("body_observer", BodyObserver(plant))
    feet = add_foot_contact(builder, scenario, human)

    builder.Connect(plant.get_state_output_port(), body.get_state_input_port())
    builder.Connect(plant.get_state_output_port(), planner.get_state_input_port())
    builder.Connect(feet.foot_forces, planner.get_foot_forces_input_port())
    builder.Connect(command.get_command_output_port(), planner.get_command_input_port())
    builder.Connect(plant.get_state_output_port(), controller.get_state_input_port())
    builder.Connect(planner.get_plan_output_port(), controller.get_plan_input_port())
    builder.Connect(controller.get_torque_output_port(), bank.get_feedforward_input_port())
    builder.Connect(controller.get_desired_state_output_port(), bank.get_desired_state_input_port())
    builder.Connect(controller.get_sample_time_output_port(), bank.get_sample_time_input_port())
    builder.Connect(plant.get_state_output_port(), bank.get_state_input_port())
    builder.Connect(plant.get_net_actuation_output_port(), bank.get_net_actuation_input_port())
    if law == "semi_implicit":
        # The bank's own law, without Python; the bank is asked for what it tells of it.
        held = builder.AddNamedSystem("held_actuation", HeldActuation(plant, human.kp, human.kd, human.effort_limits))
        builder.Connect(controller.get_torque_output_port(), held.get_feedforward_input_port())
        builder.Connect(controller.get_desired_state_output_port(), held.get_desired_state_input_port())
        builder.Connect(controller.get_sample_time_output_port(), held.get_sample_time_input_port())
        builder.Connect(plant.get_state_output_port(), held.get_state_input_port())
        builder.Connect(held.get_actuation_output_port(), plant.get_actuation_input_port())
    else:
        builder.Connect(bank.get_actuation_output_port(), plant.get_actuation_input_port())
        builder.Connect(bank.get_plant_desired_state_output_port(), plant.get_desired_state_input_port(human.instance))
    push, spatial_forces = _add_pushes(builder, scenario, plant)
    connect_spatial_forces(builder, human, (*feet.spatial_forces, *spatial_forces))

    for port, name in (
        (plant.get_state_output_port(), "state"),
        (human.scene_graph.get_query_output_port(), "query_object"),
        (plant.get_contact_results_output_port(), "contact_results"),
        (bank.get_torque_output_port(), "torque"),
        (bank.get_saturated_output_port(), "saturated"),
        (plant.get_net_actuation_output_port(), "net_actuation"),
        (controller.get_torque_output_port(), "feedforward"),
        (controller.get_desired_state_output_port(), "sample"),
        (controller.get_sample_time_output_port(), "sample_time"),
        (bank.get_held_desired_state_output_port(), "desired_state"),
        (planner.get_phase_output_port(), "phase"),
        (planner.get_contact_schedule_output_port(), "contact_schedule"),
        (body.get_soles_output_port(), "soles"),
        (body.get_com_output_port(), "com"),
        (feet.foot_forces, "foot_forces"),
        (feet.friction_use, "friction_use"),
        (command.get_command_output_port(), "command"),
        (planner.get_balance_output_port(), "balance"),
        (controller.get_status_output_port(), "qp_status"),
        (push, "push"),
    ):
        builder.ExportOutput(port, name)
    diagram = builder.Build()
    diagram.set_name("walker")
    return diagram


def _add_pushes(
    builder: DiagramBuilder, scenario: Scenario, plant: MultibodyPlant
) -> tuple[OutputPort, tuple[OutputPort, ...]]:
    """Add what pushes the body; returns the ports of the pushes' force and of the forces for the plant.

    Where a scenario has no pushes there is no source of any: the plant would ask it in every step.
    """
    if not scenario.pushes.any:
        none = builder.AddNamedSystem("pushes", ConstantVectorSource(np.zeros(3)))
        return none.get_output_port(), ()
    pushes = builder.AddNamedSystem("pushes", PushSource(plant, scenario.pushes, scenario.seed))
    return pushes.get_force_output_port(), (pushes.get_spatial_forces_output_port(),)
