"""The world that a walker lives in: body, plant and terrain in a diagram under construction."""

from dataclasses import dataclass, field

from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.framework import DiagramBuilder, OutputPort, System

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.choices.sources import FROM_SCENARIO, Sources
from humanwalk.choices.start import StartParameters
from humanwalk.control.pd_control import StepImpedance
from humanwalk.numerics import Array
from humanwalk.terrain import Terrain


@dataclass(frozen=True)
class World:
    """What a choice finds when it adds itself to the diagram.

    Attributes:
        builder: of the diagram.
        plant: finalized, with gains installed; its default positions are the start.
        instance: the body's model instance.
        scene_graph: of the plant.
        subject: whose body it is.
        terrain: the ground.
        start: noise of the start and of all gains.
        seed: of everything random, see `RandomStream`.
        kp, kd: gains of the actuators, in actuator order [N m/rad], [N m s/rad], shape (n,).
        step_impedance: of the actuation, in actuator order.
        sources: systems that command and push the walker.
        known_assistance: torques of exoskeletons that the walker's model includes; None without.
        spatial_forces: ports of forces on bodies, connected to the plant at the end.
        generalized_forces: ports of generalized forces (nv), connected to the plant at the end.
    """

    builder: DiagramBuilder
    plant: MultibodyPlant
    instance: ModelInstanceIndex
    scene_graph: SceneGraph
    subject: Subject
    terrain: Terrain
    start: StartParameters
    seed: int
    kp: Array
    kd: Array
    step_impedance: StepImpedance
    sources: Sources = FROM_SCENARIO
    known_assistance: OutputPort | None = None
    spatial_forces: list[OutputPort] = field(default_factory=list)
    generalized_forces: list[OutputPort] = field(default_factory=list)

    @property
    def model(self) -> MultibodyPlant:
        """A plant of the body alone, for kinematics and inertia."""
        return kinematics_plant(self.subject)

    @property
    def joints(self) -> JointMap:
        """The actuated joints of the plant."""
        return JointMap.of(self.plant)

    @property
    def state(self) -> OutputPort:
        """The plant's state [q; v]."""
        return self.plant.get_state_output_port()

    def port(self, system: str, name: str) -> OutputPort:
        """An output port of a system that was added before."""
        port: OutputPort = self.builder.GetSubsystemByName(system).GetOutputPort(name)
        return port

    def add[T: System](self, name: str, system: T, **inputs: OutputPort) -> T:
        """Add a named system and connect ports to its inputs of the same names."""
        added: T = self.builder.AddNamedSystem(name, system)
        for port, source in inputs.items():
            self.builder.Connect(source, added.GetInputPort(port))
        return added
