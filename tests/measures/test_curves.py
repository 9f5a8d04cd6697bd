"""Known orientations of the bodies give known anatomical angles."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant
from scipy.spatial.transform import Rotation

from humanwalk.body import SIDES, Side, human
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.markers import markers
from humanwalk.body.pelvic_plane import PELVIC_TILT, plane_tilt
from humanwalk.body.subject import Subject
from humanwalk.gait.normative import CYCLE
from humanwalk.measures.curves import ANGLES, late_stance_knee
from humanwalk.measures.orientation import pelvis_rotation, sole_rotation

MASS = 70.0


LEVEL = Rotation.identity()


def posture(pelvis: Rotation = LEVEL, **angles: float) -> pa.Table:
    """One row: the orientation of the pelvis, and joint angles [deg] of the right leg by role; the others are 0."""
    data = {f"pelvis.quaternion_{axis}": [value] for axis, value in zip("xyzw", pelvis.as_quat(), strict=True)}
    for side in SIDES:
        for joint in LEGS[side].chain:
            data[f"{joint}.angle_rad"] = [0.0]
    for role, angle in angles.items():
        data[f"{getattr(LEGS['Right'], role)}.angle_rad"] = [np.radians(angle)]
    return pa.table(data)


def angle(name: str, signals: pa.Table, side: Side = "Right", facing: complex = 1.0) -> float:
    return float(ANGLES[name].of(signals, side, MASS, facing)[0])


def test_the_pelvic_plane_leans_forward_in_standing() -> None:
    assert np.degrees(PELVIC_TILT) == pytest.approx(11.0, abs=0.5)
    assert angle("pelvis tilt", posture()) == pytest.approx(np.degrees(PELVIC_TILT))
    # The thigh is vertical.
    assert angle("hip", posture()) == pytest.approx(np.degrees(PELVIC_TILT))


@pytest.mark.parametrize("heading", [-3.0, -0.4, 0.7, 2.9])
@pytest.mark.parametrize("name", ANGLES)
def test_angles_do_not_depend_on_where_the_walk_goes(name: str, heading: float) -> None:
    pelvis = Rotation.from_euler("ZXY", [0.1, -0.07, 0.2])
    turned = Rotation.from_euler("Z", heading) * pelvis
    joints = {"hip_rotation": 8.0, "hip_flexion": 20.0, "ankle": -5.0}
    there = angle(name, posture(turned, **joints), facing=np.exp(1j * heading))
    assert there == pytest.approx(angle(name, posture(pelvis, **joints)), abs=1e-9)


@pytest.mark.parametrize(
    "subject",
    [Subject(50.0, 1.5), Subject(110.0, 1.95), Subject(60.0, 1.65, "female"), Subject(30.0, 1.35, "male", 9.0)],
)
def test_every_body_has_the_same_pelvic_plane(subject: Subject) -> None:
    assert plane_tilt(subject.skeleton) == pytest.approx(PELVIC_TILT)


def test_hip_joint_is_where_clinical_regressions_put_it() -> None:
    """From the landmarks, as Harrington et al. (2007), J. Biomech. 40:595-602: -0.24 PD - 9.9, -0.30 PW - 10.9,
    0.33 PW + 7.3 mm forward, up and outward of the middle of the anterior spines, in the axes of the pelvic plane.
    """
    skeleton = human()
    place = {m.name: np.array(m.position) for m in markers(skeleton)}
    width = 1e3 * np.linalg.norm(place["RASI"] - place["LASI"])
    front, back = ((place[f"R{name}"] + place[f"L{name}"]) / 2 for name in ("ASI", "PSI"))
    depth = 1e3 * np.linalg.norm(front - back)
    plane = Rotation.from_euler("y", PELVIC_TILT)
    hip = np.array(skeleton.joint(LEGS["Right"].hip_flexion).origin)
    x, y, z = 1e3 * plane.inv().apply(hip - front)
    regression = (-0.24 * depth - 9.9, -(0.33 * width + 7.3), -0.30 * width - 10.9)
    assert np.linalg.norm(np.subtract((x, y, z), regression)) < 25.0


@given(tilt=st.floats(-30, 30), obliquity=st.floats(-20, 20), rotation=st.floats(-20, 20))
@settings(max_examples=30)
def test_pelvis_is_measured_by_its_plane(tilt: float, obliquity: float, rotation: float) -> None:
    """Built from the plane: rotate, list, tilt a level plane, then fix the pelvis frame to it."""
    R_WA = Rotation.from_euler("ZXY", [rotation, -obliquity, tilt], degrees=True)
    signals = posture(R_WA * Rotation.from_euler("y", -PELVIC_TILT))
    assert angle("pelvis tilt", signals) == pytest.approx(tilt, abs=1e-6)
    for side, sign in (("Right", 1), ("Left", -1)):
        assert angle("pelvis obliquity", signals, side) == pytest.approx(sign * obliquity, abs=1e-6)  # type: ignore[arg-type]
        assert angle("pelvis rotation", signals, side) == pytest.approx(sign * rotation, abs=1e-6)  # type: ignore[arg-type]


@given(flexion=st.floats(-20, 60), adduction=st.floats(-20, 20), rotation=st.floats(-20, 20))
@settings(max_examples=30)
def test_hip_is_measured_between_the_pelvic_plane_and_the_thigh(
    flexion: float, adduction: float, rotation: float
) -> None:
    """The thigh turns from the axes of the plane: flexion about y, adduction about x, internal rotation about z."""
    signals = posture(hip_flexion=flexion - np.degrees(PELVIC_TILT), hip_abduction=-adduction, hip_rotation=rotation)
    for name, value in (("hip", flexion), ("hip adduction", adduction), ("hip rotation", rotation)):
        assert angle(name, signals) == pytest.approx(value, abs=1e-6)
    R_WA = pelvis_rotation(signals) * Rotation.from_euler("y", PELVIC_TILT)
    thigh = pelvis_rotation(signals)
    for name in LEGS["Right"].hip:
        thigh = thigh * Rotation.from_rotvec(
            np.outer(signals[f"{name}.angle_rad"].to_numpy(), human().joint(name).axis)
        )
    turns = (R_WA.inv() * thigh).as_euler("YXZ", degrees=True)[0]
    # Forward rotation of the thigh is negative about y, which points left; adduction of the right leg is positive
    # about x, internal rotation about z.
    np.testing.assert_allclose(turns, [-flexion, adduction, rotation], atol=1e-6)


@pytest.mark.parametrize(("side", "sign"), [("Right", 1), ("Left", -1)])
def test_toes_inward_are_positive_foot_progression(side: Side, sign: int) -> None:
    signals = posture(Rotation.from_euler("z", 7.0, degrees=True))
    assert angle("foot progression", signals, side) == pytest.approx(7.0 * sign)


def test_soles_are_oriented_as_in_the_plant(plant: MultibodyPlant, joints: JointMap, walk: Callable[..., Any]) -> None:
    signals = walk()
    context = plant.CreateDefaultContext()
    for row in (0, 130, 377):
        q = np.zeros(plant.num_positions())
        q[:4] = [signals[f"pelvis.quaternion_{axis}"][row].as_py() for axis in "wxyz"]
        for side in SIDES:
            for name in LEGS[side].chain:
                angle = signals[f"{name}.angle_rad"][row].as_py()
                q[plant.GetJointByName(name).position_start()] = angle
        plant.SetPositions(context, q)
        for side in SIDES:
            R_WS = plant.GetFrameByName(LEGS[side].sole).CalcPoseInWorld(context).rotation().matrix()
            np.testing.assert_allclose(sole_rotation(signals, side)[row].as_matrix(), R_WS, atol=1e-9)


def test_late_stance_knee_is_the_least_of_terminal_stance() -> None:
    curve = np.full(CYCLE.size, 40.0)
    curve[[20, 40, 60]] = 1.0, 12.0, 2.0
    assert late_stance_knee(curve[None]) == pytest.approx([12.0])
