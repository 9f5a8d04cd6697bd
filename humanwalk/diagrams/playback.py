"""Kinematic playback as a Diagram: gait, inverse kinematics, picture; no physics."""

from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.rendering import MultibodyPositionToGeometryPose

from humanwalk.body.plant import add_human
from humanwalk.diagrams.followed import followed_motion
from humanwalk.diagrams.ground import add_level_ground
from humanwalk.diagrams.reference import add_walking_reference
from humanwalk.diagrams.start import require_reachable
from humanwalk.scenario import Scenario
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.playback_state import PlaybackState
from humanwalk.systems.posture_interpolator import PostureInterpolator
from humanwalk.systems.recorded_posture_source import RecordedPostureSource


def make_playback(scenario: Scenario) -> Diagram:
    """Wire the walking reference of a scenario straight to the picture: what the walker would do if it could.

    Subsystems by name: scene_graph, gait, arms, inverse_kinematics, interpolator, playback_state, body_observer; with a
    recording it stands in for gait, arms, inverse_kinematics and interpolator.

    Exported outputs:
        state (97): plant state [q; v].
        desired_state (84): desired joint angles [rad], rates [rad/s].
        soles (6), com (6): see BodyObserver.
        ik_status (6): see InverseKinematicsSolver; not with a recording.
        query_object: SceneGraph's, for a visualiser.

    Raises:
        ParameterError: the scenario's gait or recording cannot be followed.
    """
    if not scenario.follow.file:
        require_reachable(scenario)
    builder = DiagramBuilder()
    scene_graph = builder.AddNamedSystem("scene_graph", SceneGraph())
    # The plant only says where its geometry is; it is no part of the diagram.
    plant = MultibodyPlant(time_step=0.0)
    plant.RegisterAsSourceForSceneGraph(scene_graph)
    add_human(plant, scenario.subject)
    add_level_ground(plant, scenario.contact)
    plant.Finalize()
    state = builder.AddNamedSystem("playback_state", PlaybackState(plant))
    body = builder.AddNamedSystem("body_observer", BodyObserver(plant))
    to_pose = builder.AddNamedSystem("to_pose", MultibodyPositionToGeometryPose(plant, input_multibody_state=True))

    if scenario.follow.file:
        source = builder.AddNamedSystem("recording", RecordedPostureSource(followed_motion(scenario)))
        pelvis, desired_state = source.get_pelvis_reference_output_port(), source.get_desired_state_output_port()
    else:
        reference = add_walking_reference(builder, scenario)
        solver = reference.inverse_kinematics
        builder.Connect(reference.gait.get_sole_targets_output_port(), solver.get_sole_targets_input_port())
        builder.Connect(reference.arms.get_posture_output_port(), solver.get_posture_input_port())
        pelvis = reference.gait.get_pelvis_reference_output_port()
        interpolator = builder.AddNamedSystem("interpolator", PostureInterpolator(plant.num_actuators()))
        builder.Connect(solver.get_previous_state_output_port(), interpolator.get_previous_state_input_port())
        builder.Connect(solver.get_previous_time_output_port(), interpolator.get_previous_time_input_port())
        builder.Connect(solver.get_desired_state_output_port(), interpolator.get_next_state_input_port())
        builder.Connect(solver.get_sample_time_output_port(), interpolator.get_next_time_input_port())
        desired_state = interpolator.get_desired_state_output_port()
        builder.ExportOutput(solver.get_status_output_port(), "ik_status")
    builder.Connect(pelvis, state.get_pelvis_reference_input_port())
    builder.Connect(desired_state, state.get_desired_state_input_port())
    builder.Connect(state.get_state_output_port(), body.get_state_input_port())
    builder.Connect(state.get_state_output_port(), to_pose.get_input_port())
    builder.Connect(to_pose.get_output_port(), scene_graph.get_source_pose_port(plant.get_source_id()))
    builder.ExportOutput(state.get_state_output_port(), "state")
    builder.ExportOutput(body.get_soles_output_port(), "soles")
    builder.ExportOutput(body.get_com_output_port(), "com")
    builder.ExportOutput(desired_state, "desired_state")
    builder.ExportOutput(scene_graph.get_query_output_port(), "query_object")
    diagram = builder.Build()
    diagram.set_name("playback")
    return diagram
