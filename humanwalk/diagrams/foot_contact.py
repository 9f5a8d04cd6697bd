"""What the ground does to the feet, whichever contact model the scenario has."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from pydrake.multibody.plant import ExternallyAppliedSpatialForceMultiplexer
from pydrake.systems.framework import DiagramBuilder, OutputPort

from humanwalk.body import SIDES, sole_patches
from humanwalk.control.ground import PlaneGround
from humanwalk.diagrams.human_plant import HumanPlant
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario
from humanwalk.systems.asperity_contact import AsperityContact
from humanwalk.systems.foot_force_observer import FootForceObserver


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
        feet = builder.AddNamedSystem("foot_force_observer", FootForceObserver(plant, human.scene_graph.model_inspector()))
        builder.Connect(plant.get_contact_results_output_port(), feet.get_contact_results_input_port())
        return FootContact(feet.get_foot_forces_output_port(), feet.get_friction_use_output_port(), ())
    if scenario.simulation.integrator != "discrete":
        raise ParameterError(
            "contact: asperity needs the discrete plant, whose step its forces are implicit in; allowed: with "
            "simulation.integrator: discrete; set it and a time_step, or contact: point"
        )
    impedance = joint_impedance(scenario, human)
    patches = [sole_patches(scenario.subject.skeleton, side) for side in SIDES]
    contact = builder.AddNamedSystem(
        "foot_contact",
        AsperityContact(
            plant, patches, PlaneGround(), scenario.asperity, impedance, scenario.simulation.control_period
        ),
    )
    builder.Connect(plant.get_state_output_port(), contact.get_state_input_port())
    return FootContact(
        contact.get_foot_forces_output_port(),
        contact.get_friction_use_output_port(),
        (contact.get_spatial_forces_output_port(),),
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


def joint_impedance(scenario: Scenario, human: HumanPlant) -> npt.NDArray[np.float64]:
    """What a step of the plant adds to the diagonal of its mass matrix for the actuators' law, shape (nv,)."""
    h = human.plant.time_step()
    damping, stiffness = {"implicit": (h, h * h), "semi_implicit": (h, 0.0), "explicit": (0.0, 0.0)}[
        scenario.actuators.law
    ]
    impedance = np.zeros(human.plant.num_velocities())
    impedance[human.joints.v] = damping * human.kd + stiffness * human.kp
    return impedance
