"""Kinematic playback: exactly the reference, and no physics."""

import numpy as np
import pytest
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Diagram

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.choices import ThesisController
from humanwalk.control.inverse_kinematics import pose_error
from humanwalk.diagrams.playback import make_playback
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario, shipped_scenarios


@pytest.fixture(scope="module", params=["thesis", "comfortable"])
def played(request: pytest.FixtureRequest) -> tuple[Scenario, Diagram]:
    scenario = load_scenario(request.param)
    return scenario, make_playback(scenario)


def test_shipped_scenarios_all_play() -> None:
    for name in shipped_scenarios():
        scenario = load_scenario(name)
        if isinstance(scenario.controller, ThesisController):
            make_playback(scenario)
        else:
            with pytest.raises(ParameterError, match="without physics"):
                make_playback(scenario)


def test_ports(played: tuple[Scenario, Diagram]) -> None:
    _, playback = played
    ports = {port.get_name(): port.size() for port in map(playback.get_output_port, range(playback.num_output_ports()))}
    assert ports == {
        "state": 97,
        "soles": 6,
        "com": 6,
        "ik_status": 6,
        "pelvis_reference": 13,
        "phase": 2,
        "contact_schedule": 2,
        "query_object": 0,
    }
    assert playback.num_input_ports() == 0


def test_no_plant_is_in_the_diagram(played: tuple[Scenario, Diagram]) -> None:
    _, playback = played
    assert not any(isinstance(system, MultibodyPlant) for system in playback.GetSystems())
    names = {system.get_name() for system in playback.GetSystems()}
    assert {"scene_graph", "gait", "arms", "inverse_kinematics", "playback_state"} <= names


def test_pelvis_and_soles_are_where_the_gait_wants_them(played: tuple[Scenario, Diagram]) -> None:
    scenario, playback = played
    gait, skeleton = scenario.controller.walk(scenario.subject), scenario.subject.skeleton  # type: ignore[attr-defined]
    plant = kinematics_plant(scenario.subject)
    context = plant.CreateDefaultContext()
    simulator = Simulator(playback)
    # Samples of the inverse kinematics: between them the desired angles stand still.
    for time in scenario.controller.control_period * np.arange(0, 400, 20):  # type: ignore[attr-defined]
        simulator.AdvanceTo(time)
        simulator.AdvancePendingEvents()
        root = simulator.get_context()
        target = gait.target(time)
        plant.SetPositionsAndVelocities(context, playback.GetOutputPort("state").Eval(root))
        X_WP = plant.GetBodyByName("Pelvis").EvalPoseInWorld(context)
        above_ground = skeleton.hip_height - target.pelvis.drop
        np.testing.assert_allclose(X_WP.translation(), [target.pelvis.distance, 0.0, above_ground], atol=1e-9)
        np.testing.assert_allclose(X_WP.rotation().matrix(), np.eye(3), atol=1e-9)
        for side in SIDES:
            foot = target.right if side == "Right" else target.left
            X_WS = plant.GetFrameByName(f"{side}Leg_Sole").CalcPoseInWorld(context)
            wanted = RigidTransform(
                RotationMatrix.MakeYRotation(foot.pitch),
                [target.pelvis.distance + foot.position[0], foot.position[1], foot.height],
            )
            # Looser than the tolerance of 1e-6: out of straight legs, the last micrometres are singular.
            assert np.abs(pose_error(X_WS, wanted)).max() < 5e-5


def test_joints_are_the_desired_ones(played: tuple[Scenario, Diagram], joints: JointMap) -> None:
    _, playback = played
    simulator = Simulator(playback)
    simulator.AdvanceTo(0.3)
    root = simulator.get_context()
    q = playback.GetOutputPort("state").Eval(root)[:49]
    between = playback.GetSubsystemByName("interpolator")
    desired = between.GetOutputPort("desired_state").Eval(between.GetMyContextFromRoot(root))
    np.testing.assert_array_equal(q[joints.q], desired[:42])
    assert (q[joints.q] >= joints.lower - 1e-9).all()
    assert (q[joints.q] <= joints.upper + 1e-9).all()


def test_picture_shows_the_body_where_the_positions_are(played: tuple[Scenario, Diagram]) -> None:
    _, playback = played
    simulator = Simulator(playback)
    simulator.AdvanceTo(0.5)
    root = simulator.get_context()
    query = playback.GetOutputPort("query_object").Eval(root)
    inspector = query.inspector()
    (pelvis,) = (frame for frame in inspector.GetAllFrameIds() if inspector.GetName(frame).endswith("Pelvis"))
    position = playback.GetOutputPort("state").Eval(root)[4:7]
    np.testing.assert_allclose(query.GetPoseInWorld(pelvis).translation(), position, atol=1e-12)


def test_unreachable_gait_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"gait\.path\.offset"):
        make_playback(load_scenario("thesis", {"controller.thesis.gait.path.offset": "0.03"}))
