"""The subject on its terrain: a plant with contact and actuation as the scenario chooses."""

from functools import partial

from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, DiscreteContactApproximation, MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort

from humanwalk.body.plant import add_human, kinematics_plant
from humanwalk.choices.sources import FROM_SCENARIO, Sources
from humanwalk.choices.start import start_positions
from humanwalk.choices.world import World
from humanwalk.contact.ground_properties import set_ground_compliance
from humanwalk.contact.leg_contact import add_leg_capsules, filter_leg_capsules
from humanwalk.contact.sole_filter import filter_soles
from humanwalk.control.gain_noise import gain_factors
from humanwalk.numerics.random_stream import RandomStream
from humanwalk.scenario import Scenario
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.signal import signals_of

APPROXIMATIONS = {
    "sap": DiscreteContactApproximation.kSap,
    "lagged": DiscreteContactApproximation.kLagged,
    "similar": DiscreteContactApproximation.kSimilar,
}


def add_world(
    builder: DiagramBuilder, scenario: Scenario, visuals: bool = True, sources: Sources = FROM_SCENARIO
) -> World:
    """Add plant, scene_graph, body_observer and foot_contact of a scenario; the plant stands at the start.

    Args:
        builder: of the diagram.
        scenario: what is simulated.
        visuals: whether geometry that is only drawn is kept; the plant moves it in every step.
        sources: systems that command and push the walker.

    Raises:
        ParameterError: the start, the gains or the contact are not possible.
    """
    subject, terrain, contact, start = scenario.subject, scenario.terrain, scenario.contact, scenario.start
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, scenario.simulation.time_step)
    set_ground_compliance(plant, scene_graph, subject.body.flesh)
    instance = add_human(plant, subject)
    terrain.add_to(plant, contact.ground_properties)
    plant.set_contact_model(contact.model)
    if plant.time_step() > 0:
        plant.set_discrete_contact_approximation(APPROXIMATIONS[scenario.simulation.contact_approximation])
    model, random = kinematics_plant(subject), RandomStream.ACTUATOR_GAINS.of(scenario.seed)
    kp, kd = (
        gain * gain_factors(gain.size, start.gain_noise, random) for gain in scenario.controller.actuator_gains(subject)
    )
    scenario.actuation.install(plant, kp, kd)
    if contact.leg_contact:
        add_leg_capsules(plant, subject.skeleton)
    plant.Finalize()
    filter_soles(plant, scene_graph, contact.collides_soles)
    if contact.leg_contact:
        filter_leg_capsules(plant, scene_graph)
    if not visuals:
        remove_visuals(plant, scene_graph)
    posture = scenario.controller.start_posture(subject, terrain)
    plant.SetDefaultPositions(start_positions(subject, terrain, start, posture, scenario.seed))

    world = World(
        builder=builder,
        plant=plant,
        instance=instance,
        scene_graph=scene_graph,
        subject=subject,
        terrain=terrain,
        start=start,
        seed=scenario.seed,
        kp=kp,
        kd=kd,
        step_impedance=partial(scenario.actuation.step_impedance, kp=kp, kd=kd),
        sources=sources,
    )
    world.add("body_observer", BodyObserver(model), state=world.state)
    contact.add_to(world)
    return world


def built(world: World, name: str, **ports: OutputPort) -> Diagram:
    """Build the diagram of a world, which exports `ports` and every `Signal` of its subsystems under their names."""
    signals = [(signal.name, signal.port) for signal in signals_of(world.builder.GetSystems())]
    for exported, port in (*ports.items(), *signals):
        world.builder.ExportOutput(port, exported)
    diagram = world.builder.Build()
    diagram.set_name(name)
    return diagram


def remove_visuals(plant: MultibodyPlant, scene_graph: SceneGraph) -> None:
    """Remove all geometry of a finalized plant that is only drawn."""
    source, inspector = plant.get_source_id(), scene_graph.model_inspector()
    assert source is not None
    for geometry in inspector.GetAllGeometryIds():
        if inspector.GetProximityProperties(geometry) is None:
            scene_graph.RemoveGeometry(source, geometry)
