"""The walking reference: gait spline source, arm swing and inverse kinematics, shared by walker and playback."""

from dataclasses import dataclass
from typing import Protocol

from pydrake.systems.framework import DiagramBuilder, OutputPort

from humanwalk.body import SIDES, Side
from humanwalk.body.plant import kinematics_plant
from humanwalk.control.joint_map import JointMap
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.scenario import Scenario
from humanwalk.systems.arm_swing_source import ArmSwingSource
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver


class SoleTargets(Protocol):
    """A system with desired poses and velocities of both soles in the pelvis frame."""

    def get_sole_pose_output_port(self, side: Side) -> OutputPort:
        """Pose of one sole, RigidTransform."""

    def get_sole_velocity_output_port(self, side: Side) -> OutputPort:
        """Velocity of one sole, SpatialVelocity."""


@dataclass(frozen=True)
class WalkingReference:
    """The three systems of a walking reference, added to a diagram and not yet connected."""

    gait: GaitSplineSource
    arms: ArmSwingSource
    inverse_kinematics: InverseKinematicsSolver


def make_gait(scenario: Scenario) -> WalkingGait:
    """The scenario's gait for the scenario's body."""
    skeleton = scenario.subject.skeleton
    gait = scenario.gait
    return WalkingGait(gait.path, skeleton.hip_half_width, gait.ramp, gait.first_swing)


def add_walking_reference(builder: DiagramBuilder, scenario: Scenario) -> WalkingReference:
    """Add the three systems, named gait, arms and inverse_kinematics."""
    plant = kinematics_plant(scenario.subject)
    gait = make_gait(scenario)
    return WalkingReference(
        gait=builder.AddNamedSystem("gait", GaitSplineSource(gait, scenario.subject.skeleton)),
        arms=builder.AddNamedSystem("arms", ArmSwingSource(JointMap.of(plant).names, gait, scenario.gait.arms)),
        inverse_kinematics=builder.AddNamedSystem(
            "inverse_kinematics",
            InverseKinematicsSolver(plant, scenario.inverse_kinematics, scenario.simulation.control_period),
        ),
    )


def connect_soles(builder: DiagramBuilder, targets: SoleTargets, solver: InverseKinematicsSolver) -> None:
    """Connect the sole targets of both feet to the inverse kinematics."""
    for side in SIDES:
        builder.Connect(targets.get_sole_pose_output_port(side), solver.get_sole_pose_input_port(side))
        builder.Connect(targets.get_sole_velocity_output_port(side), solver.get_sole_velocity_input_port(side))
