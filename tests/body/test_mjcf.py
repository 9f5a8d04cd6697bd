"""The MJCF model is the same body as the SDF model."""

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.tree import JacobianWrtVariable

from humanwalk.body.contact import contact_spheres
from humanwalk.body.impairments import JointImpairment
from humanwalk.body.joint_map import JointMap
from humanwalk.body.loads import Backpack, Suitcase
from humanwalk.body.mjcf import to_mjcf
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.sdf import LOOKS
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.exchange.mujoco_map import MujocoMap

SUBJECTS = [
    Subject(),
    Subject(mass=55.0, stature=1.6),
    Subject(26.0, 1.28, "female", 8.0, loads=(Backpack(3.0), Suitcase(2.0))),
]


@pytest.fixture(params=LOOKS)
def model(request: pytest.FixtureRequest, skeleton: Skeleton) -> Any:
    return ET.fromstring(to_mjcf(skeleton, request.param))


def test_bodies_joints_and_motors_are_the_skeletons(model: Any, skeleton: Skeleton) -> None:
    assert {body.get("name") for body in model.iter("body")} == {segment.name for segment in skeleton.segments}
    motors = [motor.get("joint") for motor in model.iter("motor")]
    assert motors == [joint.name for joint in skeleton.joints]
    assert {joint.get("name") for joint in model.iter("joint")} == set(motors)
    assert len(list(model.iter("freejoint"))) == 1


def test_bodies_have_their_parents(model: Any, skeleton: Any) -> None:
    children = {child.get("name"): body.get("name") for body in model.iter("body") for child in body.findall("body")}
    assert children == {inboard.child: inboard.parent for inboard in (*skeleton.joints, *skeleton.welds)}


def test_only_soles_touch_and_only_the_ground(model: Any, skeleton: Skeleton) -> None:
    touching = {geom.get("name") for geom in model.iter("geom") if geom.get("conaffinity") == "1"}
    assert touching == {sphere.name for sphere in contact_spheres(skeleton)}
    assert [geom.get("name") for geom in model.iter("geom") if geom.get("contype") == "1"] == ["ground"]


def test_joints_have_the_ranges_and_passive_torques_of_the_skeleton(skeleton: Skeleton) -> None:
    skeleton = JointImpairment("ankle", "Left", stiffness=40.0, rest_angle=0.1).applied(skeleton)
    for hinge in ET.fromstring(to_mjcf(skeleton)).iter("joint"):
        joint = skeleton.joint(str(hinge.get("name")))
        assert [float(x) for x in str(hinge.get("range")).split()] == pytest.approx(joint.range_rad)
        found = [float(hinge.get(name, 0.0)) for name in ("armature", "damping", "stiffness", "springref")]
        assert found == pytest.approx([joint.rotor_inertia, joint.damping, joint.stiffness, joint.rest_angle])


class Both:
    """A subject in both programs, in the same random states."""

    def __init__(self, subject: Subject) -> None:
        self.mujoco = pytest.importorskip("mujoco")
        self.plant = kinematics_plant(subject)
        self.context = self.plant.CreateDefaultContext()
        self.joints = JointMap.of(self.plant)
        self.model = self.mujoco.MjModel.from_xml_string(to_mjcf(subject.skeleton))
        self.data = self.mujoco.MjData(self.model)
        self.map = MujocoMap.of(self.joints, self.model)

    def move(self, rng: np.random.Generator) -> Any:
        q = self.plant.GetPositions(self.context)
        quaternion = rng.standard_normal(4)
        q[:4], q[4:7] = quaternion / np.linalg.norm(quaternion), rng.uniform(-1.0, 1.0, 3)
        q[self.joints.q] = rng.uniform(self.joints.lower, self.joints.upper)
        v = rng.standard_normal(self.plant.num_velocities())
        self.plant.SetPositions(self.context, q)
        self.plant.SetVelocities(self.context, v)
        T = self.map.velocity_matrix(q)
        self.data.qpos[:], self.data.qvel[:] = self.map.to_qpos(q), T.T @ v
        self.mujoco.mj_forward(self.model, self.data)
        return q, T


@pytest.fixture(params=SUBJECTS, ids=["reference", "small", "loaded girl"])
def both(request: pytest.FixtureRequest) -> Any:
    return Both(request.param)


def test_positions_survive_the_round_trip(both: Any) -> None:
    q, T = both.move(np.random.default_rng(1))
    assert np.array_equal(both.map.to_q(both.map.to_qpos(q)), q)
    assert np.allclose(T @ T.T, np.eye(T.shape[0]), atol=1e-14)


def test_mass_matrices_are_equal(both: Any) -> None:
    rng = np.random.default_rng(2)
    for _ in range(5):
        _, T = both.move(rng)
        M = both.plant.CalcMassMatrix(both.context)
        in_mujoco = np.zeros(M.shape)
        both.mujoco.mj_fullM(both.model, both.data, in_mujoco)
        assert np.abs(T @ in_mujoco @ T.T - M).max() <= 1e-9 * np.abs(M).max()


def test_gravity_and_gyroscopic_forces_are_equal(both: Any) -> None:
    rng = np.random.default_rng(3)
    for _ in range(5):
        _, T = both.move(rng)
        bias = both.plant.CalcBiasTerm(both.context) - both.plant.CalcGravityGeneralizedForces(both.context)
        assert np.abs(T @ both.data.qfrc_bias - bias).max() <= 1e-9 * np.abs(bias).max()


@pytest.mark.parametrize("name", ["Head", "RightArm_Hand", "LeftLeg_FootToes"])
def test_bodies_have_equal_motion(both: Any, name: str) -> None:
    both.move(np.random.default_rng(4))
    body = both.plant.GetBodyByName(name)
    assert both.data.body(name).xpos == pytest.approx(body.EvalPoseInWorld(both.context).translation(), abs=1e-9)
    world = both.plant.world_frame()
    J = both.plant.CalcJacobianTranslationalVelocity(
        both.context, JacobianWrtVariable.kV, body.body_frame(), np.zeros(3), world, world
    )
    velocity = np.zeros(6)
    kind = both.mujoco.mjtObj.mjOBJ_XBODY
    both.mujoco.mj_objectVelocity(both.model, both.data, kind, both.data.body(name).id, velocity, 0)
    assert velocity[3:] == pytest.approx(J @ both.plant.GetVelocities(both.context), abs=1e-8)
