"""The walking reference: gait, arm swing, inverse kinematics, interpolation; shared by walker and playback."""

from dataclasses import dataclass
from pathlib import Path

from pydrake.systems.framework import DiagramBuilder

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.gait.arm_swing import arm_joints
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.motion.followed import followed_motion
from humanwalk.motion.recorded_motion import MotionMapping, RecordedMotion
from humanwalk.scenario import Scenario, load_as
from humanwalk.systems.arm_swing_source import ArmSwingSource
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver
from humanwalk.terrain import Plane


@dataclass(frozen=True)
class WalkingReference:
    """The systems of a walking reference, added to a diagram.

    The inverse kinematics run one control period ahead; what they are fed with is still to be connected, and so is
    what goes from their last sample to the next.
    """

    gait: GaitSplineSource
    arms: ArmSwingSource
    inverse_kinematics: InverseKinematicsSolver


def make_gait(scenario: Scenario) -> WalkingGait:
    """The scenario's gait for the scenario's body."""
    skeleton = scenario.subject.skeleton
    gait = scenario.gait
    return WalkingGait(gait.path, skeleton.hip_half_width, gait.ramp, gait.first_swing)


def make_recorded_motion(scenario: Scenario) -> RecordedMotion:
    """The recording of `scenario.follow`, as motion of the scenario's body."""
    follow = scenario.follow
    mapping = load_as(MotionMapping, Path(follow.mapping)) if follow.mapping else MotionMapping()
    return followed_motion(Path(follow.file), mapping, scenario.subject, Plane(), follow.ease_in)


def add_walking_reference(builder: DiagramBuilder, scenario: Scenario) -> WalkingReference:
    """Add the systems, named gait, arms and inverse_kinematics."""
    plant = kinematics_plant(scenario.subject)
    names = JointMap.of(plant).names
    gait, arms = make_gait(scenario), scenario.gait.arms
    period = scenario.simulation.control_period
    solver = InverseKinematicsSolver(
        plant, scenario.inverse_kinematics, period, period, start_posture=standing_posture(scenario)
    )
    return WalkingReference(
        gait=builder.AddNamedSystem("gait", GaitSplineSource(gait, scenario.subject.skeleton, period)),
        arms=builder.AddNamedSystem("arms", ArmSwingSource(names, gait, arms, preview=period)),
        inverse_kinematics=builder.AddNamedSystem("inverse_kinematics", solver),
    )


def standing_posture(scenario: Scenario) -> dict[str, float]:
    """Joint angles [rad] by name of the gait at time zero, where they are not zero: legs straight, arms hanging."""
    return {name: joint.middle for name, joint in arm_joints(scenario.gait.arms).items()}
