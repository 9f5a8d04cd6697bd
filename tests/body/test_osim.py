"""The OpenSim model: as text, and loaded by OpenSim, which has the positions and the mass matrix of Drake."""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydrake.math import RigidTransform, RotationMatrix

from humanwalk.body.devices import AnkleProsthesis, HipExoskeleton
from humanwalk.body.impairments import ShortLeg, StiffKnee
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.loads import Backpack
from humanwalk.body.markers import markers
from humanwalk.body.opensim_names import COORDINATES, PELVIS_ROTATIONS, PELVIS_TRANSLATIONS, R_OW
from humanwalk.body.osim import to_osim
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject

SUBJECT = Subject(mass=60.0, stature=1.6)
EQUIPPED = Subject(
    62.0,
    1.65,
    "female",
    loads=(Backpack(8.0),),
    impairments=(ShortLeg(0.02, "Left"), StiffKnee(side="Left")),
    devices=(AnkleProsthesis(), HipExoskeleton()),
)
SUBJECTS = {"scaled": SUBJECT, "girl": Subject(26.0, 1.28, "female", 8.0), "equipped": EQUIPPED}


@pytest.fixture(scope="module")
def text() -> str:
    return to_osim(SUBJECT.skeleton)


def vectors(text: str | None) -> list[float]:
    return [float(word) for word in (text or "").split()]


@pytest.mark.parametrize("subject", SUBJECTS.values(), ids=SUBJECTS.keys())
def test_masses_centers_and_moments_of_inertia_are_the_subjects(subject: Subject) -> None:
    bodies = {body.get("name"): body for body in ET.fromstring(to_osim(subject.skeleton)).iter("Body")}
    assert len(bodies) == len(subject.skeleton.segments)
    for segment in subject.skeleton.segments:
        body = bodies[segment.name]
        assert float(body.findtext("mass") or "") == pytest.approx(segment.mass)
        assert vectors(body.findtext("mass_center")) == pytest.approx(R_OW @ segment.com, abs=1e-9)
        moments = vectors(body.findtext("inertia"))[:3]
        assert moments == pytest.approx(np.abs(R_OW) @ segment.inertia, rel=1e-8)


@pytest.mark.parametrize("subject", SUBJECTS.values(), ids=SUBJECTS.keys())
def test_segments_have_the_subjects_lengths_and_markers_its_skin(subject: Subject) -> None:
    skeleton, model = subject.skeleton, ET.fromstring(to_osim(subject.skeleton))
    joints = {joint.get("name"): joint for joint in model.iter("CustomJoint")}
    for joint in skeleton.joints:
        (offset,) = joints[joint.name].iter("PhysicalOffsetFrame")
        assert vectors(offset.findtext("translation")) == pytest.approx(R_OW @ joint.origin, abs=1e-9)
    places = {marker.get("name"): vectors(marker.findtext("location")) for marker in model.iter("Marker")}
    for marker in markers(skeleton):
        assert places[marker.name] == pytest.approx(R_OW @ marker.position, abs=1e-9)


def test_springs_of_a_prosthesis_are_forces_and_a_locked_knee_has_no_range() -> None:
    model, skeleton = ET.fromstring(to_osim(EQUIPPED.skeleton)), EQUIPPED.skeleton
    springs = {spring.findtext("coordinate"): spring for spring in model.iter("SpringGeneralizedForce")}
    ankle = springs["ankle_angle_r"]
    joint = skeleton.joint(LEGS["Right"].ankle)
    assert float(ankle.findtext("stiffness") or "") == joint.stiffness > 0.0
    assert float(ankle.findtext("rest_length") or "") == pytest.approx(joint.rest_angle)
    assert len(springs) == sum(joint.stiffness > 0.0 for joint in skeleton.joints)
    ranges = {found.get("name"): vectors(found.findtext("range")) for found in model.iter("Coordinate")}
    low, high = ranges["knee_angle_l"]
    assert abs(high - low) < 0.01
    assert not list(ET.fromstring(to_osim(SUBJECT.skeleton)).iter("SpringGeneralizedForce"))


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
