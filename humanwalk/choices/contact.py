"""What the ground does to the feet, whichever contact model the scenario has."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.multibody.plant import ExternallyAppliedSpatialForceMultiplexer, MultibodyPlant
from pydrake.systems.framework import DiagramBuilder, OutputPort

from humanwalk.body import SIDES, sole_patches
from humanwalk.body.contact import SolePatch
from humanwalk.choices.world import HumanPlant
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.contact_step import body_jacobians
from humanwalk.contact.stable_step import largest_contact_step, patch_impedance
from humanwalk.control.pd_laws import PD_LAWS
from humanwalk.numerics import Array
from humanwalk.numerics.stability import round_down
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario
from humanwalk.systems.asperity_contact import AsperityContact
from humanwalk.systems.foot_force_observer import FootForceObserver
from humanwalk.terrain import Plane


@dataclass(frozen=True)
class FootContact:
    """Ports of the feet's contact.

    Attributes:
        foot_forces: (16) see FootForceObserver.
        friction_use: (2) see FootForceObserver.
        spatial_forces: forces for the plant, where it does not make them itself.
    """

    foot_forces: OutputPort
    friction_use: OutputPort
    spatial_forces: tuple[OutputPort, ...]


def add_foot_contact(builder: DiagramBuilder, scenario: Scenario, human: HumanPlant) -> FootContact:
    """Add `foot_contact`, the asperity law, or `foot_force_observer`, which sums what Drake's own contact does.

    Raises:
        ParameterError: the asperity law cannot be simulated as the scenario asks.
    """
    plant = human.plant
    if scenario.contact != "asperity":
        feet = builder.AddNamedSystem(
            "foot_force_observer", FootForceObserver(plant, human.scene_graph.model_inspector(), Plane())
        )
        builder.Connect(plant.get_contact_results_output_port(), feet.GetInputPort("contact_results"))
        return FootContact(feet.GetOutputPort("foot_forces"), feet.GetOutputPort("friction_use"), ())
    if scenario.simulation.integrator != "discrete":
        raise ParameterError(
            "contact: asperity needs the discrete plant, whose step its forces are implicit in; allowed: with "
            "simulation.integrator: discrete; set it and a time_step, or contact: point"
        )
    feet = {side: sole_patches(scenario.subject.skeleton, side) for side in SIDES}
    joint_law = _joint_law(scenario, human)
    _require_stable_contact(
        plant, [patch for foot in feet.values() for patch in foot], scenario.asperity, joint_law, human
    )
    contact = builder.AddNamedSystem(
        "foot_contact",
        AsperityContact(
            plant,
            feet,
            Plane(),
            scenario.asperity,
            joint_law(plant.time_step())[0],
        ),
    )
    builder.Connect(plant.get_state_output_port(), contact.GetInputPort("state"))
    return FootContact(
        contact.GetOutputPort("foot_forces"),
        contact.GetOutputPort("friction_use"),
        (contact.GetOutputPort("spatial_forces"),),
    )


def connect_spatial_forces(builder: DiagramBuilder, human: HumanPlant, ports: Sequence[OutputPort]) -> None:
    """Connect all of the ports' lists of forces to the plant's applied_spatial_force port."""
    if len(ports) > 1:
        every = builder.AddNamedSystem("spatial_forces", ExternallyAppliedSpatialForceMultiplexer(len(ports)))
        for place, port in enumerate(ports):
            builder.Connect(port, every.get_input_port(place))
        ports = (every.get_output_port(),)
    for port in ports:
        builder.Connect(port, human.plant.get_applied_spatial_force_input_port())


def _joint_law(scenario: Scenario, human: HumanPlant) -> Callable[[float], tuple[Array, Array]]:
    """What a step h of the actuators' law adds to the diagonal of the mass matrix, and what it takes explicitly."""
    kp, kd = _in_velocities(human, human.kp), _in_velocities(human, human.kd)
    return lambda h: PD_LAWS[scenario.actuators.law].impedance(h, kp, kd)


def _in_velocities(human: HumanPlant, gains: Array) -> Array:
    """Gains in actuator order, put where the plant has the joints' velocities; shape (nv,)."""
    values = np.zeros(human.plant.num_velocities())
    values[human.joints.v] = gains
    return values


def _require_stable_contact(
    plant: MultibodyPlant,
    patches: Sequence[SolePatch],
    parameters: AsperityParameters,
    joint_law: Callable[[float], tuple[Array, Array]],
    human: HumanPlant,
) -> None:
    """Raise ParameterError if the contact would diverge at the plant's step under a body in neutral standing."""
    context = plant.CreateDefaultContext()
    J = body_jacobians(plant, context, [plant.GetBodyByName(patch.body) for patch in patches])
    R_SW = Plane().axes(np.zeros(2))
    # Standing, every body of the feet is turned as the world is.
    r, area = np.array([patch.p_BoQ_B for patch in patches]), np.array([patch.area for patch in patches])
    stable = largest_contact_step(
        plant.CalcMassMatrix(context),
        J,
        patch_impedance(r, area, R_SW, parameters.normal_stiffness, parameters.spring_stiffness),
        patch_impedance(r, area, R_SW, parameters.normal_damping, parameters.velocity_stiffness),
        joint_law,
        _in_velocities(human, human.kp),
    )
    if plant.time_step() > stable:
        raise ParameterError(
            f"asperity: unstable at time_step {plant.time_step():g} s; allowed: steps up to {round_down(stable):g} s "
            "with these joints, stiffness and damping; lower simulation.time_step"
        )
