"""The controller that follows recorded joint angles, with the pelvis supported, or without physics."""

from dataclasses import dataclass
from typing import Any

from pydrake.systems.framework import OutputPort

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.body_units import scaled
from humanwalk.choices.controller import JointCommand
from humanwalk.choices.recording_file import RecordingFile
from humanwalk.choices.start import StartPosture
from humanwalk.choices.support import add_support
from humanwalk.choices.world import World
from humanwalk.control.balance_support import BalanceSupportParameters
from humanwalk.control.joint_gains import JointGains, joint_gains
from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, quantity
from humanwalk.systems.recorded_posture_source import RecordedPostureSource
from humanwalk.terrain import Terrain


@dataclass(frozen=True)
class RecordedController(RecordingFile):
    """A recording followed joint by joint."""

    kinematic: bool = False
    """Show the recording without physics: no forces, no torques, no balance."""

    ease_in: float = quantity(0.3, "s", 0.0, 5.0)
    """Time in which the recording gets up to speed, since the body starts at rest."""

    support: BalanceSupportParameters = BalanceSupportParameters()
    """The assumed balance: a spring-damper on the pelvis; for the reference body, scales with the subject."""

    gains: JointGains = JointGains()

    command = commanded_speed = followed_style = None

    @property
    def physics(self) -> bool:
        return not self.kinematic

    @property
    def untested(self) -> tuple[str, ...]:
        return ()

    def fields_for_speed(self, speed: float) -> dict[str, Any]:
        """Raise ParameterError: the recording has its own speed."""
        raise ParameterError(
            f"--speed {speed:g}: a recording has its own speed; allowed: with a controller that is commanded; leave it "
            "out"
        )

    def steady_from(self, subject: Subject) -> float:
        """When the recording runs at full speed [s]."""
        return self.ease_in

    def actuator_gains(self, subject: Subject) -> tuple[Array, Array]:
        return joint_gains(kinematics_plant(subject), self.gains, subject.scale)

    def start_posture(self, subject: Subject, terrain: Terrain) -> StartPosture:
        """The first sample of the recording."""
        motion = self.motion(subject, terrain)
        names = JointMap.of(kinematics_plant(subject)).names
        return StartPosture(dict(zip(names, motion.joints(0.0)[0].tolist(), strict=True)), motion.pelvis(0.0).X_WP)

    def add_to(self, world: World) -> JointCommand:
        """Add recording and support.

        Raises:
            ParameterError: the recording or its mapping cannot be used.
        """
        pelvis_reference, desired_state = self.add_reference(world)
        add_support(world, scaled(self.support, world.subject.scale), pelvis_reference)
        return JointCommand(desired_state)

    def add_reference(self, world: World) -> tuple[OutputPort, OutputPort]:
        source = world.add("recording", RecordedPostureSource(self.motion(world.subject, world.terrain)))
        return source.GetOutputPort("pelvis_reference"), source.GetOutputPort("desired_state")

    def motion(self, subject: Subject, terrain: Terrain) -> RecordedMotion:
        """The recording as motion of a subject on a terrain."""
        return self.read(subject, terrain, self.ease_in)
