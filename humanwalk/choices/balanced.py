"""The walker on its own feet as a Diagram: command, step planner, whole-body controller, PD actuators, plant."""

from dataclasses import replace

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body import SIDES
from humanwalk.body.plant import kinematics_plant
from humanwalk.choices.contact import add_foot_contact, connect_spatial_forces
from humanwalk.choices.start import start_positions
from humanwalk.choices.world import add_human_plant
from humanwalk.control.gain_noise import noisy_tasks
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.command_source import CommandSource
from humanwalk.systems.gait_planner import GaitPlanner
from humanwalk.systems.pd_actuator_bank import PdActuatorBank
from humanwalk.systems.push_source import PushSource
from humanwalk.systems.whole_body_controller import WholeBodyController
from humanwalk.terrain import Plane

START_FLEXION = 0.12
"""Flexion of hip and ankle at the start, half of the knee's [rad]: a straight leg cannot be shortened."""

TASK_GAINS = 3
"""What their noise is drawn from together with the scenario's seed."""


def make_balanced_walker(scenario: Scenario, visuals: bool = True) -> Diagram:
    """Wire the walker of a scenario that balances by itself; its default context stands at the scenario's start.

    Subsystems by name: plant, scene_graph, command, planner, controller, actuators, pushes (a PushSource where the
    scenario has any, or zero), body_observer, foot_force_observer, or foot_contact with `contact: asperity`.

    Exported outputs, joints in actuator order, named as those of `make_walker`:
        state (97), query_object, contact_results, torque (42), saturated (42), desired_state (84),
        phase (2), contact_schedule (2), soles (6), com (6), foot_forces (16), friction_use (2);
    and its own:
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
        "planner", GaitPlanner(model, walk.planner, scenario.gait.first_swing, walk.control_period, Plane())
    )
    posture = {f"{side}ArmElbowMotion": scenario.gait.arms.elbow_flexion for side in SIDES}
    tasks = noisy_tasks(walk.whole_body, scenario.start.gain_noise, np.random.default_rng((scenario.seed, TASK_GAINS)))
    controller = builder.AddNamedSystem(
        "controller",
        WholeBodyController(model, scenario.subject.skeleton, tasks, posture, walk.control_period, Plane()),
    )
    bank = builder.AddNamedSystem("actuators", PdActuatorBank(plant, human.kp, human.kd, law, human.effort_limits))
    body = builder.AddNamedSystem("body_observer", BodyObserver(plant))
    feet = add_foot_contact(builder, scenario, human)

    builder.Connect(plant.get_state_output_port(), body.GetInputPort("state"))
    builder.Connect(plant.get_state_output_port(), planner.GetInputPort("state"))
    builder.Connect(feet.foot_forces, planner.GetInputPort("foot_forces"))
    builder.Connect(command.GetOutputPort("command"), planner.GetInputPort("command"))
    builder.Connect(plant.get_state_output_port(), controller.GetInputPort("state"))
    builder.Connect(planner.GetOutputPort("plan"), controller.GetInputPort("plan"))
    builder.Connect(controller.GetOutputPort("torque"), bank.GetInputPort("feedforward"))
    builder.Connect(controller.GetOutputPort("desired_state"), bank.GetInputPort("desired_state"))
    builder.Connect(controller.GetOutputPort("sample_time"), bank.GetInputPort("sample_time"))
    builder.Connect(plant.get_state_output_port(), bank.GetInputPort("state"))
    builder.Connect(plant.get_net_actuation_output_port(), bank.GetInputPort("net_actuation"))
    builder.Connect(bank.GetOutputPort("actuation"), plant.get_actuation_input_port())
    if law == "implicit":
        builder.Connect(bank.GetOutputPort("plant_desired_state"), plant.get_desired_state_input_port(human.instance))
    push, spatial_forces = _add_pushes(builder, scenario, plant)
    connect_spatial_forces(builder, human, (*feet.spatial_forces, *spatial_forces))

    for port, name in (
        (plant.get_state_output_port(), "state"),
        (human.scene_graph.get_query_output_port(), "query_object"),
        (plant.get_contact_results_output_port(), "contact_results"),
        (bank.GetOutputPort("torque"), "torque"),
        (bank.GetOutputPort("saturated"), "saturated"),
        (bank.GetOutputPort("held_desired_state"), "desired_state"),
        (planner.GetOutputPort("phase"), "phase"),
        (planner.GetOutputPort("contact_schedule"), "contact_schedule"),
        (body.GetOutputPort("soles"), "soles"),
        (body.GetOutputPort("com"), "com"),
        (feet.foot_forces, "foot_forces"),
        (feet.friction_use, "friction_use"),
        (command.GetOutputPort("command"), "command"),
        (planner.GetOutputPort("balance"), "balance"),
        (controller.GetOutputPort("status"), "qp_status"),
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
    return pushes.GetOutputPort("force"), (pushes.GetOutputPort("spatial_forces"),)
