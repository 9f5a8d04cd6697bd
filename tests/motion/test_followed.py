"""A recording as motion of the body: by names, by a mapping, with or without a pelvis path."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.body import contact_spheres
from humanwalk.body.impairments import ShortLeg, StiffKnee
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import SPINE_PITCH_JOINTS
from humanwalk.body.opensim_names import COORDINATES
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.motion.followed import REQUIRED_JOINTS, followed_motion
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.motion.recorded_motion import MotionMapping, RecordedMotion
from humanwalk.numerics import Array
from humanwalk.parameter_file import load_as
from humanwalk.quantity import ParameterError
from humanwalk.terrain import Plane

TIME = np.arange(0, 1.001, 0.02)
LEVEL = Plane()
REFERENCE = Subject()


def squat(depth: float = 0.6) -> dict[str, Array]:
    """Hips, knees and ankles bend together, so that the soles stay level; OpenSim's names, degrees."""
    bend = np.rad2deg(depth * np.sin(0.5 * np.pi * TIME) ** 2)
    columns = {COORDINATES[name][0]: np.zeros_like(TIME) for name in REQUIRED_JOINTS}
    for side in "rl":
        columns |= {f"hip_flexion_{side}": bend, f"knee_angle_{side}": 2 * bend, f"ankle_angle_{side}": bend}
    return columns


def write_mot(path: Path, columns: dict[str, Array]) -> Path:
    path.write_text(storage_text("t", MotionTable(tuple(columns), TIME, np.column_stack(list(columns.values())), True)))
    return path


def read(path: Any, mapping: Any = None, terrain: Any = LEVEL, subject: Subject = REFERENCE) -> RecordedMotion:
    mapping = load_as(MotionMapping, mapping) if mapping else MotionMapping()
    return followed_motion(path, mapping, subject, terrain, ease_in=0.3)


def refusal(path: Path, mapping: Path | None = None) -> str:
    with pytest.raises(ParameterError) as raised:
        read(path, mapping)
    assert len(str(raised.value).splitlines()) == 1
    return str(raised.value)


@pytest.fixture
def squat_file(tmp_path: Path) -> Path:
    return write_mot(tmp_path / "squat.mot", squat())


def test_opensim_names_and_degrees_are_read(squat_file: Path, joints: JointMap) -> None:
    motion = read(squat_file)
    place = {name: i for i, name in enumerate(joints.names)}
    np.testing.assert_allclose(motion.angles[-1, place["RightLegTibiaMotion"]], 1.2, atol=1e-9)
    assert not motion.angles[:, place["Head_Motion"]].any()


def test_own_joint_names_are_read_and_opensim_signs_are_converted(tmp_path: Path, joints: JointMap) -> None:
    columns = squat() | {"hip_adduction_r": np.full_like(TIME, -10.0), "Head_Motion": np.full_like(TIME, 20.0)}
    motion = read(write_mot(tmp_path / "t.mot", columns))
    angle = dict(zip(joints.names, motion.angles[0], strict=True))
    assert angle["RightLegFemurSideMotion"] == pytest.approx(np.deg2rad(10))
    assert angle["Head_Motion"] == pytest.approx(np.deg2rad(20))


def test_opensims_back_joint_is_distributed_over_the_spine(tmp_path: Path, joints: JointMap) -> None:
    columns = squat() | {"lumbar_extension": np.full_like(TIME, -20.0)}
    motion = read(write_mot(tmp_path / "t.mot", columns))
    angle = dict(zip(joints.names, motion.angles[0], strict=True))
    assert sum(angle[name] for name in SPINE_PITCH_JOINTS) == pytest.approx(np.deg2rad(20))


def test_mapping_renames_scales_and_changes_units(tmp_path: Path, joints: JointMap) -> None:
    names = [name for name in REQUIRED_JOINTS if name != "LeftLegFemurTwistMotion"]
    knee = np.linspace(0, 0.5, TIME.size)
    columns = {f"c{i}": -knee if "Tibia" in name else np.zeros_like(TIME) for i, name in enumerate(names)}
    csv = tmp_path / "lab.csv"
    rows = np.column_stack((TIME, *columns.values()))
    csv.write_text("\n".join([",".join(("time", *columns)), *(",".join(map(repr, row.tolist())) for row in rows)]))
    mapping = tmp_path / "map.yaml"
    entries = "".join(
        f"  {name}: {{column: c{i}{', scale: -1' if 'Tibia' in name else ''}}}\n" for i, name in enumerate(names)
    )
    mapping.write_text(f"angle_unit: rad\ncolumns:\n{entries}hold: {{LeftLegFemurTwistMotion: 0.1}}\n")
    motion = read(csv, mapping)
    place = {name: i for i, name in enumerate(joints.names)}
    np.testing.assert_allclose(motion.angles[:, place["LeftLegTibiaMotion"]], knee, atol=1e-9)
    np.testing.assert_allclose(motion.angles[:, place["LeftLegFemurTwistMotion"]], 0.1)


def test_a_joint_that_is_held_needs_no_readable_column(tmp_path: Path, joints: JointMap) -> None:
    csv = tmp_path / "lab.csv"
    columns = {f"{name}_deg": values for name, values in squat().items()}
    columns["hip_rotation_r"] = columns.pop("hip_rotation_r_deg")
    rows = np.column_stack((TIME, *columns.values()))
    csv.write_text("\n".join([",".join(("time", *columns)), *(",".join(map(repr, row.tolist())) for row in rows)]))
    mapping = tmp_path / "map.yaml"
    mapping.write_text("hold: {RightLegFemurTwistMotion: 0.1}\n")
    place = joints.names.index("RightLegFemurTwistMotion")
    np.testing.assert_allclose(read(csv, mapping).angles[:, place], 0.1)


@pytest.mark.parametrize(("unit", "length"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001)])
def test_the_pelvis_path_has_the_unit_of_its_columns(tmp_path: Path, unit: str, length: float) -> None:
    path = {f"pelvis_tx_{unit}": TIME / length, f"pelvis_ty_{unit}": 0.0 * TIME, f"pelvis_tz_{unit}": 0.0 * TIME}
    motion = read(write_mot(tmp_path / "t.mot", squat(0) | path))
    np.testing.assert_allclose(motion.pelvis_position[-1, :2], [1.0, 0.0], atol=1e-9)


def test_error_names_all_missing_joints_and_the_fix(tmp_path: Path) -> None:
    columns = squat()
    del columns["knee_angle_r"], columns["hip_rotation_l"]
    message = refusal(write_mot(tmp_path / "t.mot", columns))
    assert "no column for RightLegTibiaMotion, LeftLegFemurTwistMotion" in message
    assert "knee_angle_r" in message
    assert "--mapping" in message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("columns: {RightLegTibiaMotion: {column: kneeangle_r}}", "did you mean knee_angle_r?"),
        ("columns: {RightLegTibaMotion: {column: knee_angle_r}}", "did you mean RightLegTibiaMotion?"),
        ("hold: {RightKnee: 0}", "hold.RightKnee: no such joint; allowed: the 42 joints of the body; "),
        ("hold: {pelvis_tilt: 0.1}", "hold.pelvis_tilt: no such joint; allowed: the 42 joints of the body; "),
        ("angle_unit: degrees", "allowed: auto, deg, rad"),
        ("columns: [1]", "name: value pairs"),
        ("columns: {RightLegTibiaMotion: {column: knee_angle_r, scale: .nan}}", "finite"),
        ("angle_unit: rad", "check the unit"),
        ("columns: {RightLegTibiaMotion: {column: knee_angle_r, scale: -1}}", "the sign"),
        ("!!python/object/apply:os.system ['true']", "map.yaml"),
        ("columns: {RightLegTibiaMotion: &a {column: *a}}", "map.yaml"),
    ],
)
def test_invalid_mapping_produces_a_one_line_error(tmp_path: Path, squat_file: Path, text: str, message: str) -> None:
    mapping = tmp_path / "map.yaml"
    mapping.write_text(text)
    assert message in refusal(squat_file, mapping)


def test_csv_without_unit_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("time," + ",".join(REQUIRED_JOINTS) + "\n0" + ",0" * 10 + "\n1" + ",0" * 10 + "\n")
    assert "unknown angle unit" in refusal(path)


@pytest.mark.parametrize(("unit", "radian"), [("deg", float(np.rad2deg(1.0))), ("rad", 1.0)])
def test_every_angle_can_have_its_unit_in_the_name_of_its_column(
    tmp_path: Path, joints: JointMap, unit: str, radian: float
) -> None:
    angles = {f"{COORDINATES[name][0]}_{unit}": 0.0 for name in REQUIRED_JOINTS}
    angles |= {f"{name}_{unit}": 0.1 for name in ("knee_angle_r", "hip_adduction_r", "RightArmElbowMotion")}
    angles |= {f"{name}_{unit}": 0.2 for name in ("pelvis_tilt", "lumbar_extension")}
    path = tmp_path / "t.csv"
    rows = (",".join((time, *(repr(radian * angle) for angle in angles.values()))) for time in ("0", "1"))
    path.write_text("\n".join((",".join(("time", *angles)), *rows)))
    motion = read(path)
    angle = dict(zip(joints.names, motion.angles[0], strict=True))
    assert angle["RightLegTibiaMotion"] == angle["RightArmElbowMotion"] == pytest.approx(0.1)
    assert angle["RightLegFemurSideMotion"] == pytest.approx(-0.1)
    assert sum(angle[name] for name in SPINE_PITCH_JOINTS) == pytest.approx(-0.2)
    np.testing.assert_allclose(motion.pelvis_angles[0], [-0.2, 0.0, 0.0])


def test_columns_that_are_not_used_are_logged(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    read(write_mot(tmp_path / "all.mot", squat()))
    assert not caplog.messages
    read(write_mot(tmp_path / "more.mot", squat() | {"pelvis_tilt": TIME, "pelvis_tilts": TIME, "emg": TIME}))
    (message,) = caplog.messages
    assert message.endswith("more.mot: columns that are not used: pelvis_tilts, emg")


def test_part_of_a_pelvis_path_is_refused(tmp_path: Path) -> None:
    path = write_mot(tmp_path / "t.mot", squat() | {"pelvis_tx": TIME})
    assert "all three or none" in refusal(path)


def test_a_path_in_another_unit_than_that_of_the_mapping_is_refused(tmp_path: Path) -> None:
    zero = np.zeros_like(TIME)
    path = {"pelvis_tx": 900.0 * TIME, "pelvis_ty": zero, "pelvis_tz": zero}
    recording = write_mot(tmp_path / "t.mot", squat() | path)
    assert "pelvis_tx, pelvis_ty, pelvis_tz move at 900 m/s at" in refusal(recording)
    assert "allowed: up to 10 m/s; check their unit (length_unit: mm) in --mapping" in refusal(recording)
    mapping = tmp_path / "map.yaml"
    mapping.write_text("length_unit: mm")
    assert read(recording, mapping).pelvis_position[-1, 0] == pytest.approx(0.9)


def clearance(motion: RecordedMotion, joints: JointMap, row: int, terrain: Plane = LEVEL) -> float:
    """Height of the lowest point of the soles above the ground [m]."""
    plant = kinematics_plant(Subject())
    context = plant.CreateDefaultContext()
    q = plant.GetPositions(context)
    q[joints.q] = motion.angles[row]
    q[4:7] = motion.pelvis_position[row]
    plant.SetPositions(context, q)
    bodies = [(plant.GetBodyByName(s.body), s) for s in contact_spheres(Subject().skeleton)]
    points = [body.EvalPoseInWorld(context) @ np.array(s.center) - [0.0, 0.0, s.radius] for body, s in bodies]
    return min(point[2] - terrain.height(point[:2]) for point in points)


def test_without_a_recorded_path_the_stance_foot_does_not_slide(squat_file: Path, joints: JointMap) -> None:
    motion = read(squat_file)
    drop = motion.pelvis_position[0, 2] - motion.pelvis_position[-1, 2]
    assert drop == pytest.approx(Subject().skeleton.leg_length * (1 - np.cos(0.6)), abs=1e-6)
    for row in (0, 25, -1):
        assert clearance(motion, joints, row) == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(
    "subject",
    [Subject(50.0, 1.5), Subject(62.0, 1.7, "female"), Subject(20.0, 1.1, "male", 6.0), Subject(95.0, 2.0, "male")],
    ids=str,
)
def test_recorded_angles_are_followed_on_the_subjects_own_legs(squat_file: Path, subject: Subject) -> None:
    motion, skeleton, row = read(squat_file, subject=subject), subject.skeleton, -1
    reference = read(squat_file)
    np.testing.assert_array_equal(motion.angles, reference.angles)
    drop = motion.pelvis_position[0, 2] - motion.pelvis_position[row, 2]
    assert drop == pytest.approx(skeleton.leg_length * (1 - np.cos(0.6)), rel=1e-6)
    assert motion.pelvis_position[0, 2] == pytest.approx(skeleton.root_height, abs=1e-6)


def test_the_longer_leg_stands_on_the_ground(squat_file: Path) -> None:
    motion = read(squat_file, subject=Subject(impairments=(ShortLeg(0.03),)))
    drop = motion.pelvis_position[0, 2] - motion.pelvis_position[-1, 2]
    assert drop == pytest.approx(Subject().skeleton.leg_length * (1 - np.cos(0.6)), abs=1e-6)


def test_angles_beyond_the_range_of_a_stiff_knee_are_refused(squat_file: Path) -> None:
    with pytest.raises(ParameterError, match="RightLegTibiaMotion"):
        read(squat_file, subject=Subject(impairments=(StiffKnee(),)))


def test_recorded_path_starts_above_the_origin_with_the_soles_on_the_ground(tmp_path: Path, joints: JointMap) -> None:
    path = {"pelvis_tx": 3 + TIME, "pelvis_ty": np.full_like(TIME, 1.3), "pelvis_tz": np.full_like(TIME, -2.0)}
    motion = read(write_mot(tmp_path / "t.mot", squat(0) | path))
    np.testing.assert_allclose(motion.pelvis_position[0, :2], 0, atol=1e-12)
    np.testing.assert_allclose(motion.pelvis_position[-1, :2], [1.0, 0.0], atol=1e-9)
    assert clearance(motion, joints, 0) == pytest.approx(0, abs=1e-6)


def test_on_a_slope_the_soles_stand_on_it(tmp_path: Path, joints: JointMap) -> None:
    slope = Plane(slope=0.1)
    path = {"pelvis_tx": 0.5 * TIME, "pelvis_ty": np.ones_like(TIME), "pelvis_tz": np.zeros_like(TIME)}
    for recorded in ({}, path):
        motion = read(write_mot(tmp_path / "t.mot", squat() | recorded), terrain=slope)
        assert clearance(motion, joints, 0, slope) == pytest.approx(0, abs=1e-9)
    motion = read(write_mot(tmp_path / "t.mot", squat()), terrain=slope)
    for row in (10, -1):
        assert clearance(motion, joints, row, slope) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("columns", "mapping", "message"),
    [
        ({"pelvis_tx": 1e9, "pelvis_ty": 0.0, "pelvis_tz": 0.0}, "", "pelvis path reaches"),
        (
            {"pelvis_tx": 1e9, "pelvis_ty": 1e9, "pelvis_tz": 1e9},
            "columns: {pelvis_tx: {column: pelvis_tx, scale: 1e6}}",
            "pelvis path reaches",
        ),
        ({"pelvis_tilt": 1e9}, "", "pelvis_tilt reaches"),
        ({"Head_Motion": 1e10}, "columns: {Head_Motion: {column: Head_Motion, scale: 1.0e6}}", "Head_Motion is"),
        ({}, "hold: {Head_Motion: .nan}", "hold.Head_Motion: nan is out of range"),
        ({}, "hold: {Head_Motion: 1.0e308}", "hold.Head_Motion: 1e+308 is out of range"),
        ({}, f"columns: {{Head_Motion: {{column: {'x' * 50_000}}}}}", "no column"),
    ],
    ids=range(7),
)
def test_huge_values_produce_a_short_one_line_error(
    tmp_path: Path, columns: dict[str, Any], mapping: str, message: str
) -> None:
    recording = write_mot(tmp_path / "t.mot", squat() | {name: np.full_like(TIME, v) for name, v in columns.items()})
    (tmp_path / "map.yaml").write_text(mapping)
    error = refusal(recording, tmp_path / "map.yaml")
    assert message in error
    assert len(error) < 1000
