"""What every controller is: it knows its gains and its start, and turns the world's state into a command."""

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from pydrake.systems.framework import OutputPort

from humanwalk.body.subject import Subject
from humanwalk.choices.start import StartPosture
from humanwalk.choices.world import World
from humanwalk.numerics import Array
from humanwalk.terrain import Terrain
from humanwalk.walking.command import CommandParameters


@dataclass(frozen=True)
class JointCommand:
    """Ports that an actuation takes, joints in actuator order.

    Attributes:
        desired_state: (2n) desired angles [rad], then rates [rad/s].
        sample_time: (1) the time for which they are desired [s]; without it they are always current.
        previous_state, previous_time: the sample before; without it the desired rates lead on from the last one.
        feedforward: (n) torque [N m]; without it the diagram has an input port of this name.
    """

    desired_state: OutputPort
    sample_time: OutputPort | None = None
    previous_state: OutputPort | None = None
    previous_time: OutputPort | None = None
    feedforward: OutputPort | None = None

    @property
    def ports(self) -> dict[str, OutputPort]:
        """The ports that there are, by name."""
        return {name: port for name, port in vars(self).items() if port is not None}


class Controller(Protocol):
    """One way to walk: a dataclass whose fields are the group of the scenario that its tag opens."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def physics(self) -> bool:
        """Whether the body is simulated; else its motion is prescribed (`make_playback`)."""

    @property
    def command(self) -> CommandParameters | None:
        """Commanded velocity over time, which describes a path on the ground; None where a reference prescribes it."""

    @property
    def commanded_speed(self) -> float | None:
        """Greatest forward speed that is commanded [m/s]; None where a recording prescribes it."""

    @property
    def untested(self) -> tuple[str, ...]:
        """What is commanded beyond the tested range, one line each."""

    @property
    def followed_style(self) -> str | None:
        """Tag of the joint angles that a walker on its own feet also follows; None for another controller."""

    def fields_for_speed(self, speed: float) -> dict[str, Any]:
        """Fields of the controller, by dotted name, with the values for another greatest forward speed [m/s].

        Raises:
            ParameterError: the controller takes no speed.
        """

    def steady_from(self, subject: Subject) -> float:
        """Time from which the walk is steady, so that measures count [s]."""

    def actuator_gains(self, subject: Subject) -> tuple[Array, Array]:
        """kp [N m/rad] and kd [N m s/rad] of a subject's actuators, shape (n,) each, in actuator order.

        Raises:
            ParameterError: a gain is given for a joint that the body does not have.
        """

    def start_posture(self, subject: Subject, terrain: Terrain) -> StartPosture:
        """What the body starts from."""

    def add_to(self, world: World) -> JointCommand:
        """Add the controller's systems to the world's diagram.

        Raises:
            ParameterError: the controller cannot work in this world.
        """

    def add_reference(self, world: World) -> tuple[OutputPort, OutputPort]:
        """Add the reference alone, which is shown without physics; returns pelvis_reference (13), desired_state (2n).

        Raises:
            ParameterError: the controller has no reference, or the body cannot follow it.
        """
