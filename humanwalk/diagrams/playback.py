"""Kinematic playback as a Diagram: gait, inverse kinematics, picture; no physics."""

from pydrake.geometry import SceneGraph
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.rendering import MultibodyPositionToGeometryPose

from humanwalk.body.plant import add_human
from humanwalk.choices.reference import add_walking_reference, make_recorded_motion
from humanwalk.choices.start import require_reachable
from humanwalk.contact.ground_properties import ground_properties
from humanwalk.scenario import Scenario
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.playback_state import PlaybackState
from humanwalk.systems.posture_interpolator import PostureInterpolator
from humanwalk.systems.recorded_posture_source import RecordedPostureSource
from humanwalk.terrain import Plane


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
    Plane().add_to(plant, ground_properties)
    plant.Finalize()
    state = builder.AddNamedSystem("playback_state", PlaybackState(plant))
    body = builder.AddNamedSystem("body_observer", BodyObserver(plant))
    to_pose = builder.AddNamedSystem("to_pose", MultibodyPositionToGeometryPose(plant, input_multibody_state=True))

    if scenario.follow.file:
        source = builder.AddNamedSystem("recording", RecordedPostureSource(make_recorded_motion(scenario)))
        pelvis, desired_state = source.GetOutputPort("pelvis_reference"), source.GetOutputPort("desired_state")
    else:
        reference = add_walking_reference(builder, scenario)
        solver = reference.inverse_kinematics
        builder.Connect(reference.gait.GetOutputPort("sole_targets"), solver.GetInputPort("sole_targets"))
        builder.Connect(reference.arms.GetOutputPort("posture"), solver.GetInputPort("posture"))
        pelvis = reference.gait.GetOutputPort("pelvis_reference")
        interpolator = builder.AddNamedSystem("interpolator", PostureInterpolator(plant.num_actuators()))
        builder.Connect(solver.GetOutputPort("previous_state"), interpolator.GetInputPort("previous_state"))
        builder.Connect(solver.GetOutputPort("previous_time"), interpolator.GetInputPort("previous_time"))
        builder.Connect(solver.GetOutputPort("desired_state"), interpolator.GetInputPort("next_state"))
        builder.Connect(solver.GetOutputPort("sample_time"), interpolator.GetInputPort("next_time"))
        desired_state = interpolator.GetOutputPort("desired_state")
        builder.ExportOutput(solver.GetOutputPort("status"), "ik_status")
    builder.Connect(pelvis, state.GetInputPort("pelvis_reference"))
    builder.Connect(desired_state, state.GetInputPort("desired_state"))
    builder.Connect(state.GetOutputPort("state"), body.GetInputPort("state"))
    builder.Connect(state.GetOutputPort("state"), to_pose.get_input_port())
    builder.Connect(to_pose.get_output_port(), scene_graph.get_source_pose_port(plant.get_source_id()))
    builder.ExportOutput(state.GetOutputPort("state"), "state")
    builder.ExportOutput(body.GetOutputPort("soles"), "soles")
    builder.ExportOutput(body.GetOutputPort("com"), "com")
    builder.ExportOutput(desired_state, "desired_state")
    builder.ExportOutput(scene_graph.get_query_output_port(), "query_object")
    diagram = builder.Build()
    diagram.set_name("playback")
    return diagram
