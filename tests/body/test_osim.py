"""The OpenSim model: as text, and loaded by OpenSim, which has the positions and the mass matrix of Drake."""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydrake.math import RigidTransform, RotationMatrix

from humanwalk.body.joint_map import JointMap
from humanwalk.body.markers import markers
from humanwalk.body.opensim_names import COORDINATES, PELVIS_ROTATIONS, PELVIS_TRANSLATIONS, R_OW
from humanwalk.body.osim import to_osim
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject

SUBJECT = Subject(mass=60.0, stature=1.6)


@pytest.fixture(scope="module")
def text() -> str:
    return to_osim(SUBJECT.skeleton)


def test_it_has_the_bodies_joints_and_markers_of_the_skeleton(text: str) -> None:
    model, skeleton = ET.fromstring(text), SUBJECT.skeleton
    assert {body.get("name") for body in model.iter("Body")} == {segment.name for segment in skeleton.segments}
    assert sum(float(mass.text or 0.0) for mass in model.iter("mass")) == pytest.approx(60.0)
    names = {joint.name for joint in skeleton.joints} | {weld.name for weld in skeleton.welds}
    assert {joint.get("name") for kind in ("CustomJoint", "WeldJoint") for joint in model.iter(kind)} == {
        *names,
        "ground_Pelvis",
    }
    assert {marker.get("name") for marker in model.iter("Marker")} == {marker.name for marker in markers(skeleton)}


def test_coordinates_have_the_names_of_exported_motions(text: str) -> None:
    names = {coordinate.get("name") for coordinate in ET.fromstring(text).iter("Coordinate")}
    joints = {COORDINATES.get(joint.name, (joint.name, 1.0))[0] for joint in SUBJECT.skeleton.joints}
    assert names == {*joints, *PELVIS_ROTATIONS, *PELVIS_TRANSLATIONS}


@pytest.fixture(scope="module")
def opensim() -> Any:
    module = pytest.importorskip("opensim", reason="optional extra opensim")
    module.Logger.setLevelString("Warn")
    return module


@pytest.fixture(scope="module")
def model(opensim: Any, text: str, tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("osim") / "human.osim"
    Path(path).write_text(text)
    loaded = opensim.Model(str(path))
    loaded.initSystem()
    return loaded


def test_opensim_has_the_positions_of_drake(opensim: Any, model: Any) -> None:
    plant = kinematics_plant(SUBJECT)
    context, joints = plant.CreateDefaultContext(), JointMap.of(plant)
    rng = np.random.default_rng(1)
    q = plant.GetPositions(context)
    q[joints.q] = rng.uniform(joints.lower, joints.upper)
    plant.SetPositions(context, q)
    R_WP, p_WP = RotationMatrix.MakeZRotation(0.4), np.array([1.0, -0.5, 0.9])
    plant.SetFreeBodyPose(context, plant.GetBodyByName("Pelvis"), RigidTransform(R_WP, p_WP))

    state = model.initSystem()
    values = dict(zip(PELVIS_TRANSLATIONS, R_OW @ p_WP, strict=True)) | {"pelvis_rotation": 0.4}
    for name, angle in zip(joints.names, q[joints.q], strict=True):
        coordinate, factor = COORDINATES.get(name, (name, 1.0))
        values[coordinate] = factor * angle
    for name, value in values.items():
        model.updCoordinateSet().get(name).setValue(state, value, False)
    model.realizePosition(state)
    for segment in SUBJECT.skeleton.segments:
        place = model.getBodySet().get(segment.name).getPositionInGround(state)
        found = R_OW.T @ [place.get(i) for i in range(3)]
        wanted = plant.GetBodyByName(segment.name).EvalPoseInWorld(context).translation()
        np.testing.assert_allclose(found, wanted, atol=1e-8, err_msg=segment.name)
    mass, center = model.getTotalMass(state), model.calcMassCenterPosition(state)
    assert mass == pytest.approx(60.0)
    found = R_OW.T @ [center.get(i) for i in range(3)]
    np.testing.assert_allclose(found, plant.CalcCenterOfMassPositionInWorld(context), atol=1e-8)


def test_opensim_has_the_inertia_of_drake(opensim: Any, model: Any) -> None:
    """The kinetic energy of every joint alone, at rest posture; drake's includes that of the rotors."""
    plant = kinematics_plant(SUBJECT)
    context, joints = plant.CreateDefaultContext(), JointMap.of(plant)
    state = model.initSystem()
    for name in ("RightLegFemurMotion", "LeftArmShoulderSideMotion", "Lumbar_3_Motion"):
        i = joints.names.index(name)
        v = np.zeros(plant.num_velocities())
        v[joints.v[i]] = 1.0
        plant.SetVelocities(context, v)
        rotor = 0.5 * SUBJECT.skeleton.joint(name).rotor_inertia
        coordinate = model.updCoordinateSet().get(COORDINATES.get(name, (name, 1.0))[0])
        coordinate.setSpeedValue(state, 1.0)
        model.realizeVelocity(state)
        assert model.calcKineticEnergy(state) == pytest.approx(plant.CalcKineticEnergy(context) - rotor, rel=1e-6)
        coordinate.setSpeedValue(state, 0.0)
