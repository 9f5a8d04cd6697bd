"""The walker of a scenario as a Diagram."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from pydrake.multibody.plant import ExternallyAppliedSpatialForceMultiplexer
from pydrake.systems.framework import Diagram, DiagramBuilder, InputPort, OutputPort, System
from pydrake.systems.primitives import Adder

from humanwalk.choices.controller import JointCommand
from humanwalk.choices.exoskeleton import add_exoskeleton
from humanwalk.choices.pushes import add_pushes
from humanwalk.choices.sources import FROM_SCENARIO, Sources
from humanwalk.choices.world import World
from humanwalk.diagrams.playback import make_playback
from humanwalk.diagrams.world import add_world, built
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, require_scenario


def make_walker(scenario: Scenario, visuals: bool = True, sources: Sources = FROM_SCENARIO) -> Diagram:
    """Wire the walker of a scenario; its default context stands at the scenario's start.

    It stands at rest: the noise of the rates (`start.rate_noise`) is set by `humanwalk.run.simulate.prepare`.

    Subsystems by name: plant, scene_graph, body_observer, foot_contact, actuators, pushes and, where enabled,
    leg_contact; and those of the controller: gait, arms, inverse_kinematics and, where enabled, support,
    foot_force_balance, upper_body_balance (thesis); command, load_observer, planner, controller (balanced); recording,
    support (recorded). The actuation adds integral_action (pid) or adaptive_feedforward (adaptive), a subject with an
    exoskeleton the system exoskeleton.

    Exported outputs: state (97), net_actuation (42), contact_results, query_object, and every `Signal` of a subsystem
    under its name: desired_state (84), torque (42), saturated (42), soles (6), com (6), foot_forces (16),
    friction_use (2), leg_contact (1), push (3), and those of the controller: ik_status (6), pelvis_reference (13),
    phase (2), contact_schedule (2), support_wrench (6), foot_shift (12), alpha (4) (thesis); phase (2),
    contact_schedule (2), command (3), felt_load (4), balance (9), qp_status (3) (balanced); pelvis_reference (13),
    support_wrench (6) (recorded); and those of the actuation: integral_torque (42) (pid); estimates (84) (adaptive);
    and exoskeleton_torque (42) of an exoskeleton. Joints come in actuator order.

    Exported inputs: feedforward (42), torque added to every actuator's law [N m]; optional, and only where the
    controller has none of its own. exoskeleton_command (42), torque added to that of an exoskeleton [N m]; optional.

    Args:
        scenario: what is simulated.
        visuals: whether geometry that is only drawn is kept; the plant moves it in every step.
        sources: systems that command and push the walker.

    Raises:
        ParameterError: the scenario's choices do not go together, or one of them cannot be simulated.
    """
    require_scenario(scenario, "make_walker")
    if not scenario.controller.physics:
        raise ParameterError(
            "make_walker: this controller has no physics; allowed: one with forces; build it with make_playback, or "
            "set kinematic: false"
        )
    builder = DiagramBuilder()
    world = add_world(builder, scenario, visuals, sources)
    world = replace(world, known_assistance=add_exoskeleton(world))
    scenario.actuation.add_to(world)
    _connect_command(builder, scenario.controller.add_to(world))
    add_pushes(world, scenario.pushes)
    _connect_forces(world)
    return built(
        world,
        "walker",
        state=world.state,
        net_actuation=world.plant.get_net_actuation_output_port(),
        contact_results=world.plant.get_contact_results_output_port(),
        query_object=world.scene_graph.get_query_output_port(),
    )


def make_diagram(scenario: Scenario, visuals: bool = True, sources: Sources = FROM_SCENARIO) -> Diagram:
    """The walker of a scenario, or its playback where the controller has no physics."""
    require_scenario(scenario, "make_diagram")
    return make_walker(scenario, visuals, sources) if scenario.controller.physics else make_playback(scenario)


def _connect_command(builder: DiagramBuilder, command: JointCommand) -> None:
    """Connect a command with the actuators; a feedforward that it lacks becomes an input of the diagram."""
    actuators = builder.GetSubsystemByName("actuators")
    for name, port in command.ports.items():
        builder.Connect(port, actuators.GetInputPort(name))
    if command.feedforward is None:
        builder.ExportInput(actuators.GetInputPort("feedforward"), "feedforward")


def _connect_forces(world: World) -> None:
    """Connect the forces on bodies and the generalized forces with the plant."""
    plant = world.plant
    spatial = plant.get_applied_spatial_force_input_port()
    _connect_sum(world, "spatial_forces", world.spatial_forces, spatial, ExternallyAppliedSpatialForceMultiplexer)
    generalized = plant.get_applied_generalized_force_input_port()
    adder = partial(Adder, size=plant.num_velocities())
    _connect_sum(world, "generalized_forces", world.generalized_forces, generalized, adder)


def _connect_sum(
    world: World, name: str, ports: Sequence[OutputPort], goal: InputPort, adder: Callable[[int], System]
) -> None:
    """Connect the sum of the ports with a goal, through an adder of that name if there are several."""
    if len(ports) > 1:
        total = world.builder.AddNamedSystem(name, adder(len(ports)))
        for i, port in enumerate(ports):
            world.builder.Connect(port, total.get_input_port(i))
        ports = (total.get_output_port(),)
    for port in ports:
        world.builder.Connect(port, goal)
