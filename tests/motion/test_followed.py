"""A recording becomes a motion of the body: by names, by a mapping, with or without a pelvis path; and is followed."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.body import contact_spheres
from humanwalk.body.limbs import SPINE_PITCH_JOINTS
from humanwalk.body.opensim_names import COORDINATES
from humanwalk.body.plant import Subject, kinematics_plant
from humanwalk.diagrams.playback import make_playback
from humanwalk.diagrams.walker import make_walker
from humanwalk.motion.followed import NEEDED, followed_motion
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario

TIME = np.arange(0, 1.001, 0.02)


def squat(depth=0.6):
    """Hips, knees and ankles bend together, so that the soles stay level; OpenSim's names, degrees."""
    bend = np.rad2deg(depth * np.sin(0.5 * np.pi * TIME) ** 2)
    columns = {COORDINATES[name][0]: np.zeros_like(TIME) for name in NEEDED}
    for side in "rl":
        columns |= {f"hip_flexion_{side}": bend, f"knee_angle_{side}": 2 * bend, f"ankle_angle_{side}": bend}
    return columns


def write_mot(path, columns):
    path.write_text(storage_text("t", MotionTable(tuple(columns), TIME, np.column_stack(list(columns.values())), True)))
    return path


def following(path, mapping=None, **changes):
    overrides = {"follow.file": str(path), **({"follow.mapping": str(mapping)} if mapping else {})}
    return load_scenario("thesis", overrides | changes)


def refusal(scenario):
    with pytest.raises(ParameterError) as raised:
        followed_motion(scenario)
    assert len(str(raised.value).splitlines()) == 1
    return str(raised.value)


@pytest.fixture
def squat_file(tmp_path):
    return write_mot(tmp_path / "squat.mot", squat())


def test_opensims_names_and_degrees_are_understood(squat_file, joints):
    motion = followed_motion(following(squat_file))
    place = {name: i for i, name in enumerate(joints.names)}
    np.testing.assert_allclose(motion.angles[-1, place["RightLegTibiaMotion"]], 1.2, atol=1e-9)
    assert not motion.angles[:, place["Head_Motion"]].any()


def test_joints_own_names_win_and_signs_are_opensims(tmp_path, joints):
    columns = squat() | {"hip_adduction_r": np.full_like(TIME, -10.0), "Head_Motion": np.full_like(TIME, 20.0)}
    motion = followed_motion(following(write_mot(tmp_path / "t.mot", columns)))
    angle = dict(zip(joints.names, motion.angles[0], strict=True))
    assert angle["RightLegFemurSideMotion"] == pytest.approx(np.deg2rad(10))
    assert angle["Head_Motion"] == pytest.approx(np.deg2rad(20))


def test_opensims_back_is_shared_out(tmp_path, joints):
    columns = squat() | {"lumbar_extension": np.full_like(TIME, -20.0)}
    motion = followed_motion(following(write_mot(tmp_path / "t.mot", columns)))
    angle = dict(zip(joints.names, motion.angles[0], strict=True))
    assert sum(angle[name] for name in SPINE_PITCH_JOINTS) == pytest.approx(np.deg2rad(20))


def test_mapping_renames_scales_and_changes_units(tmp_path, joints):
    names = [name for name in NEEDED if name != "LeftLegFemurTwistMotion"]
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
    motion = followed_motion(following(csv, mapping))
    place = {name: i for i, name in enumerate(joints.names)}
    np.testing.assert_allclose(motion.angles[:, place["LeftLegTibiaMotion"]], knee, atol=1e-9)
    np.testing.assert_allclose(motion.angles[:, place["LeftLegFemurTwistMotion"]], 0.1)


def test_missing_joints_are_all_named_with_what_would_do(tmp_path):
    columns = squat()
    del columns["knee_angle_r"], columns["hip_rotation_l"]
    message = refusal(following(write_mot(tmp_path / "t.mot", columns)))
    assert "no column for RightLegTibiaMotion, LeftLegFemurTwistMotion" in message
    assert "knee_angle_r" in message
    assert "--mapping" in message


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("columns: {RightLegTibiaMotion: {column: kneeangle_r}}", "did you mean knee_angle_r?"),
        ("columns: {RightLegTibaMotion: {column: knee_angle_r}}", "did you mean RightLegTibiaMotion?"),
        ("hold: {RightKnee: 0}", "no such joint"),
        ("angle_unit: degrees", "allowed: auto, deg, rad"),
        ("columns: [1]", "name: value pairs"),
        ("columns: {RightLegTibiaMotion: {column: knee_angle_r, scale: .nan}}", "finite"),
        ("angle_unit: rad", "check the unit"),
        ("columns: {RightLegTibiaMotion: {column: knee_angle_r, scale: -1}}", "the sign"),
        ("!!python/object/apply:os.system ['true']", "map.yaml"),
        ("columns: {RightLegTibiaMotion: &a {column: *a}}", "map.yaml"),
    ],
)
def test_mapping_that_cannot_be_used_is_refused(tmp_path, squat_file, text, said):
    mapping = tmp_path / "map.yaml"
    mapping.write_text(text)
    assert said in refusal(following(squat_file, mapping))


def test_csv_without_unit_is_refused(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("time," + ",".join(NEEDED) + "\n0" + ",0" * 10 + "\n1" + ",0" * 10 + "\n")
    assert "in degrees or radians?" in refusal(following(path))


def test_part_of_a_pelvis_path_is_refused(tmp_path):
    path = write_mot(tmp_path / "t.mot", squat() | {"pelvis_tx": TIME})
    assert "all three or none" in refusal(following(path))


def test_balance_levels_do_not_go_with_a_recording(squat_file):
    with pytest.raises(ParameterError, match="joint by joint"):
        following(squat_file, **{"balance.upper_body.enabled": "true"})


def lowest(motion, joints, row):
    plant = kinematics_plant(Subject())
    context = plant.CreateDefaultContext()
    q = plant.GetPositions(context)
    q[joints.q] = motion.angles[row]
    q[4:7] = motion.pelvis_place[row]
    plant.SetPositions(context, q)
    spheres = contact_spheres(Subject().skeleton)
    return min(
        (plant.GetBodyByName(s.body).EvalPoseInWorld(context) @ np.array(s.center))[2] - s.radius for s in spheres
    )


def test_without_a_path_the_pelvis_goes_where_the_feet_carry_it(squat_file, joints):
    motion = followed_motion(following(squat_file))
    drop = motion.pelvis_place[0, 2] - motion.pelvis_place[-1, 2]
    thigh, shank = 0.4242, 0.439767
    assert drop == pytest.approx((thigh + shank) * (1 - np.cos(0.6)), abs=1e-6)
    for row in (0, 25, -1):
        assert lowest(motion, joints, row) == pytest.approx(0, abs=1e-6)


def test_recorded_path_is_moved_to_start_on_the_ground_above_the_origin(tmp_path, joints):
    path = {"pelvis_tx": 3 + TIME, "pelvis_ty": np.full_like(TIME, 1.3), "pelvis_tz": np.full_like(TIME, -2.0)}
    motion = followed_motion(following(write_mot(tmp_path / "t.mot", squat(0) | path)))
    np.testing.assert_allclose(motion.pelvis_place[0, :2], 0, atol=1e-12)
    np.testing.assert_allclose(motion.pelvis_place[-1, :2], [1.0, 0.0], atol=1e-9)
    assert lowest(motion, joints, 0) == pytest.approx(0, abs=1e-6)


def test_playback_shows_the_recording_exactly(squat_file, joints):
    scenario = following(squat_file)
    playback = make_playback(scenario)
    motion = followed_motion(scenario)
    context = playback.CreateDefaultContext()
    context.SetTime(0.8)
    angles, _ = motion.joints(0.8)
    np.testing.assert_allclose(playback.GetOutputPort("desired_state").Eval(context)[:42], angles)
    np.testing.assert_allclose(playback.GetOutputPort("state").Eval(context)[joints.q], angles)


def test_walker_follows_the_recording_with_the_support(squat_file, joints):
    """Through the PD bank, against gravity: half a second of bending the knees."""
    scenario = following(squat_file)
    walker = make_walker(scenario)
    simulator = Simulator(walker)
    simulator.AdvanceTo(0.6)
    context = simulator.get_context()
    state = walker.GetOutputPort("state").Eval(context)
    wanted, _ = followed_motion(scenario).joints(0.6)
    assert wanted[joints.names.index("RightLegTibiaMotion")] > 0.3
    np.testing.assert_allclose(joints.positions(state), wanted, atol=0.05)
    np.testing.assert_allclose(state[4:7], walker.GetOutputPort("pelvis_reference").Eval(context)[4:7], atol=0.03)
    np.testing.assert_allclose(walker.GetOutputPort("desired_state").Eval(context)[:42], wanted, atol=1e-9)
