"""The URDF model, read back by Drake: the same body as the SDF model."""

import numpy as np
import pytest
from pydrake.geometry import SceneGraph
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.loads import Backpack, Suitcase
from humanwalk.body.plant import add_human
from humanwalk.body.sdf import LOOKS, Look
from humanwalk.body.subject import Subject
from humanwalk.body.urdf import to_urdf

SUBJECTS = [
    Subject(),
    Subject(mass=50.0, stature=1.5),
    Subject(26.0, 1.28, "female", 8.0, loads=(Backpack(3.0), Suitcase(2.0))),
]


def read_back(subject: Subject, look: Look = "person") -> tuple[MultibodyPlant, SceneGraph]:
    plant, scene = MultibodyPlant(time_step=0.0), SceneGraph()
    plant.RegisterAsSourceForSceneGraph(scene)
    parser = Parser(plant)
    parser.SetStrictParsing()
    parser.AddModelsFromString(to_urdf(subject.skeleton, look), "urdf")
    plant.Finalize()
    return plant, scene


def original(subject: Subject) -> tuple[MultibodyPlant, SceneGraph]:
    plant, scene = MultibodyPlant(time_step=0.0), SceneGraph()
    plant.RegisterAsSourceForSceneGraph(scene)
    add_human(plant, subject)
    plant.Finalize()
    return plant, scene


@pytest.mark.parametrize("subject", SUBJECTS, ids=["reference", "small", "loaded girl"])
def test_mass_matrix_bias_and_gravity_are_those_of_the_sdf_model(subject: Subject) -> None:
    urdf, sdf = read_back(subject)[0], original(subject)[0]
    assert JointMap.of(urdf).names == JointMap.of(sdf).names
    rng = np.random.default_rng(1)
    contexts = [plant.CreateDefaultContext() for plant in (urdf, sdf)]
    for _ in range(3):
        q = sdf.GetPositions(contexts[1])
        q[:4] = rng.standard_normal(4)
        q[:4] /= np.linalg.norm(q[:4])
        joints = JointMap.of(sdf)
        q[joints.q] = rng.uniform(joints.lower, joints.upper)
        v = rng.standard_normal(sdf.num_velocities())
        for plant, context in zip((urdf, sdf), contexts, strict=True):
            plant.SetPositions(context, q)
            plant.SetVelocities(context, v)
        (M, bias, gravity), (M0, bias0, gravity0) = (
            (plant.CalcMassMatrix(c), plant.CalcBiasTerm(c), plant.CalcGravityGeneralizedForces(c))
            for plant, c in zip((urdf, sdf), contexts, strict=True)
        )
        assert np.abs(M - M0).max() <= 1e-9 * np.abs(M0).max()
        assert np.abs(bias - bias0).max() <= 1e-9 * np.abs(bias0).max()
        assert np.abs(gravity - gravity0).max() <= 1e-9 * np.abs(gravity0).max()
        for leg in LEGS.values():
            soles = [p.GetFrameByName(leg.sole).CalcPoseInWorld(c) for p, c in zip((urdf, sdf), contexts, strict=True)]
            assert soles[0].IsNearlyEqualTo(soles[1], 1e-9)


def test_joints_have_the_limits_damping_and_rotor_inertia_of_the_sdf_model() -> None:
    urdf, sdf = read_back(Subject())[0], original(Subject())[0]
    for name in JointMap.of(sdf).names:
        a, b = (plant.GetJointByName(name) for plant in (urdf, sdf))
        assert (a.position_lower_limits(), a.position_upper_limits()) == (
            pytest.approx(b.position_lower_limits()),
            pytest.approx(b.position_upper_limits()),
        )
        assert a.default_damping_vector() == pytest.approx(b.default_damping_vector())
        a, b = (plant.GetJointActuatorByName(name) for plant in (urdf, sdf))
        assert a.effort_limit() == pytest.approx(b.effort_limit())
        assert a.default_rotor_inertia() == pytest.approx(b.default_rotor_inertia())


@pytest.mark.parametrize("look", LOOKS)
def test_shapes_are_those_of_the_sdf_model(look: Look) -> None:
    subject = Subject(look=look)
    counts = []
    for plant, scene in (read_back(subject, look), original(subject)):
        inspector = scene.model_inspector()
        bodies = [plant.GetBodyByName(segment.name) for segment in subject.skeleton.segments]
        visual = sum(len(plant.GetVisualGeometriesForBody(body)) for body in bodies)
        contact = {
            (inspector.GetName(g).partition("::")[2], type(inspector.GetShape(g)).__name__, properties_of(inspector, g))
            for body in bodies
            for g in plant.GetCollisionGeometriesForBody(body)
        }
        counts.append((visual, contact))
    assert counts[0] == counts[1]


def properties_of(inspector: object, geometry: object) -> str:
    properties = inspector.GetProximityProperties(geometry)  # type: ignore[attr-defined]
    groups = {group: sorted(properties.GetPropertiesInGroup(group)) for group in properties.GetGroupNames()}
    return str(groups)
