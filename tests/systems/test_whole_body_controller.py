"""The whole-body controller as a system: ports, order of the joints, and QP failures."""

from dataclasses import replace

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context

from humanwalk.body.contact import sole_extent
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import ARMS, HEAD_YAW, LEGS
from humanwalk.body.skeleton import Skeleton
from humanwalk.contact.ground_force import FootForces
from humanwalk.control.whole_body_parameters import WholeBodyParameters
from humanwalk.numerics import Array
from humanwalk.sides import SIDES, Side
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.whole_body_controller import ELBOW_PER_SHOULDER, WholeBodyController
from humanwalk.terrain import Plane
from humanwalk.walking.command import Command
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.step_planner import StepPlanner
from humanwalk.walking.walking_reference import BodyState, WalkingReference

PERIOD = 0.004
LOADED = FootForces.of(np.tile((0.0, 0.0, 350.0, 0.0, 0.0, 0.0, 0.0, 1.0), 2))


@pytest.fixture
def controller(plant: MultibodyPlant, skeleton: Skeleton) -> WholeBodyController:
    return WholeBodyController(plant, skeleton, WholeBodyParameters(), {ARMS["Left"].elbow: 0.4}, PERIOD)


@pytest.fixture
def standing(plant: MultibodyPlant, joints: JointMap) -> Array:
    q = plant.GetPositions(plant.CreateDefaultContext())
    for leg in LEGS.values():
        for joint, angle in ((leg.hip_flexion, 0.12), (leg.knee, 0.24), (leg.ankle, 0.12)):
            q[joints.q[joints.names.index(joint)]] = angle
    q[6] -= 0.0065
    return np.concatenate((q, np.zeros(plant.num_velocities())))


@pytest.fixture
def plan(plant: MultibodyPlant, skeleton: Skeleton, standing: Array) -> WalkingReference:
    observer = BodyObserver(plant)
    context = observer.CreateDefaultContext()
    observer.GetInputPort("state").FixValue(context, standing)
    com, ankles = (observer.GetOutputPort(name).Eval(context) for name in ("com", "ankles"))
    body = BodyState.measured(com, ankles.reshape(2, 5, 3), LOADED, Plane())
    planner = StepPlanner(StepPlannerParameters(), 0.98, 0.068, 0.864, "Right", PERIOD, sole_extent(skeleton), Plane())
    return planner.update(planner.start(body), body, Command())[1]


def updated(controller: WholeBodyController, context: Context) -> None:
    context.SetDiscreteState(controller.EvalUniquePeriodicDiscreteUpdate(context))


def context_with(controller: WholeBodyController, state: Array, plan: WalkingReference) -> Context:
    context = controller.CreateDefaultContext()
    controller.GetInputPort("state").FixValue(context, state)
    controller.GetInputPort("plan").FixValue(context, plan)
    return context


def test_ports(controller: WholeBodyController) -> None:
    outputs = [controller.get_output_port(i) for i in range(controller.num_output_ports())]
    assert [(port.get_name(), port.size()) for port in outputs] == [
        ("torque", 42),
        ("desired_state", 84),
        ("sample_time", 1),
        ("status", 3),
    ]


def test_both_knees_support_the_body(
    controller: WholeBodyController, joints: JointMap, standing: Array, plan: WalkingReference
) -> None:
    context = context_with(controller, standing, plan)
    updated(controller, context)
    torque = controller.GetOutputPort("torque").Eval(context)
    assert controller.GetOutputPort("status").Eval(context) == pytest.approx([1, 0, 0])
    knee = [torque[joints.names.index(leg.knee)] for leg in LEGS.values()]
    assert knee[0] == pytest.approx(knee[1], abs=6.0)
    # The torque of a bent knee under load is extension: negative.
    assert knee[0] < -10.0


def test_arms_move_toward_their_posture(
    controller: WholeBodyController, joints: JointMap, standing: Array, plan: WalkingReference
) -> None:
    context = context_with(controller, standing, plan)
    updated(controller, context)
    rates = controller.GetOutputPort("desired_state").Eval(context)[42:]
    assert rates[joints.names.index(ARMS["Left"].elbow)] > 0.0
    assert rates[joints.names.index(ARMS["Right"].elbow)] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("side", SIDES)
def test_each_arm_and_each_foot_follow_the_plan_of_their_side(
    controller: WholeBodyController, joints: JointMap, standing: Array, plan: WalkingReference, side: Side
) -> None:
    """Arms have prescribed accelerations: from rest they have the rate of the first period."""
    swing, none, toes = (0.2, 0.0), (0.0, 0.0), (0.3, 0.5)
    arms = (swing, none) if side == "Right" else (none, swing)
    foot = {side.lower(): replace(plan.foot(side), toes=toes)}
    angles, rates = [], []
    for planned in (plan, replace(plan, shoulder_flexion=arms, **foot)):  # type: ignore[arg-type]
        context = context_with(controller, standing, planned)
        updated(controller, context)
        angle, rate = np.split(controller.GetOutputPort("desired_state").Eval(context), 2)
        angles.append(dict(zip(joints.names, angle, strict=True)))
        rates.append(dict(zip(joints.names, rate, strict=True)))
    per_angle = PERIOD * WholeBodyParameters().arms.stiffness
    flexion = {ARMS[side].shoulder_flexion: swing[0], ARMS[side].elbow: ELBOW_PER_SHOULDER * swing[0]}
    for arm in ARMS.values():
        for joint in (arm.shoulder_flexion, arm.elbow):
            assert rates[1][joint] - rates[0][joint] == pytest.approx(per_angle * flexion.get(joint, 0.0), abs=1e-9)
    for name, leg in LEGS.items():
        assert (angles[1][leg.toes], rates[1][leg.toes]) == (toes if name == side else none)


def test_actuators_deliver_what_a_known_device_leaves(
    controller: WholeBodyController, joints: JointMap, standing: Array, plan: WalkingReference
) -> None:
    """Of a joint with prescribed motion; nothing else changes."""
    assistance = np.zeros(42)
    assistance[joints.names.index(ARMS["Right"].elbow)] = 3.0
    context = context_with(controller, standing, plan)
    torques = []
    for known in (np.zeros(42), assistance):
        controller.GetInputPort("assistance").FixValue(context, known)
        updated(controller, context)
        torques.append(controller.GetOutputPort("torque").Eval(context).copy())
    assert torques[1] + assistance == pytest.approx(torques[0], abs=1e-6)


def test_after_qp_failures_the_last_torque_is_held_for_a_while(
    controller: WholeBodyController, standing: Array, plan: WalkingReference
) -> None:
    context = context_with(controller, standing, plan)
    updated(controller, context)
    held = controller.GetOutputPort("torque").Eval(context).copy()
    broken = standing.copy()
    broken[-48:] = 1e4
    controller.GetInputPort("state").FixValue(context, broken)
    for failures in range(1, 8):
        updated(controller, context)
        assert controller.GetOutputPort("status").Eval(context) == pytest.approx([0, failures, failures])
        expected = held if failures * PERIOD <= WholeBodyParameters().hold else np.zeros(42)
        assert controller.GetOutputPort("torque").Eval(context) == pytest.approx(expected)
    controller.GetInputPort("state").FixValue(context, standing)
    updated(controller, context)
    assert controller.GetOutputPort("status").Eval(context) == pytest.approx([1, 7, 0])


def test_the_head_turns_as_planned(
    controller: WholeBodyController, joints: JointMap, standing: Array, plan: WalkingReference
) -> None:
    """Neck and head have prescribed accelerations: from rest, a turned head has the rate of the first period."""
    context = context_with(controller, standing, replace(plan, head_yaw=(0.1, 0.0)))
    updated(controller, context)
    _, rate = np.split(controller.GetOutputPort("desired_state").Eval(context), 2)
    assert rate[joints.names.index(HEAD_YAW)] == pytest.approx(PERIOD * WholeBodyParameters().arms.stiffness * 0.1)
