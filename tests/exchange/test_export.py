"""Exported files, read back by independent readers, have the numbers, units and axes of the run."""

import csv
import shutil
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.io import loadmat
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from humanwalk.body import SIDES, human
from humanwalk.body.markers import markers
from humanwalk.body.opensim_names import COORDINATES, PELVIS_TRANSLATIONS, R_OW, SPINE_COORDINATES
from humanwalk.body.pelvic_plane import PELVIC_TILT
from humanwalk.cli.main import app
from humanwalk.exchange import FORMATS, export_run, forces_left_out
from humanwalk.exchange.motion import ground_force, marker_paths
from humanwalk.measures.effort import joint_names
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import SIGNALS, Run
from humanwalk.run.outcome import Outcome
from humanwalk.sides import Side
from humanwalk.systems.push_source import FORCE_COLUMNS
from humanwalk.terrain import Plane


def read_storage(path: Path) -> tuple[dict[str, str], dict[str, Array]]:
    """Header flags, and columns by name."""
    head, _, body = path.read_text().partition("endheader\n")
    flags = dict(line.split("=") for line in head.splitlines() if "=" in line)
    names, *rows = (line.split("\t") for line in body.splitlines())
    data = np.array(rows, dtype=float)
    assert flags["version"] == "1"
    assert (int(flags["nRows"]), int(flags["nColumns"])) == data.shape
    assert names[0] == "time"
    return flags, dict(zip(names, data.T, strict=True))


def read_trc(path: Path) -> tuple[dict[str, Array], Array, dict[str, str]]:
    """Marker paths in millimeters by name, the frames' times, and the header."""
    lines = path.read_text().split("\n")
    head = dict(zip(lines[1].split("\t"), lines[2].split("\t"), strict=True))
    names = lines[3].split("\t")[2::3]
    assert lines[4].split("\t")[2:] == [f"{axis}{i + 1}" for i in range(len(names)) for axis in "XYZ"]
    data = np.array([line.split("\t") for line in lines[6:] if line], dtype=float)
    assert data.shape == (int(head["NumFrames"]), 2 + 3 * len(names))
    assert len(names) == int(head["NumMarkers"])
    np.testing.assert_array_equal(data[:, 0], 1 + np.arange(data.shape[0]))
    return {name: data[:, 2 + 3 * i : 5 + 3 * i] for i, name in enumerate(names)}, data[:, 1], head


@pytest.fixture(scope="module")
def opensim_folder(run: Run) -> Path:
    export_run(run, "opensim")
    return run.path / "opensim"


def test_files_are_those_of_the_format(run: Run, opensim_folder: Path) -> None:
    assert {path.name for path in opensim_folder.iterdir()} == {
        "angles.mot",
        "clinical_angles.sto",
        "torques.sto",
        "ground_forces.mot",
        "external_loads.xml",
        "markers.trc",
    }


def test_angles_are_degrees_with_opensims_names_and_signs(opensim_folder: Path, signals: pa.Table) -> None:
    flags, columns = read_storage(opensim_folder / "angles.mot")
    assert flags["inDegrees"] == "yes"
    np.testing.assert_allclose(columns["time"], signals[TIME].to_numpy(), atol=1e-12)
    for joint in joint_names(signals):
        coordinate, factor = COORDINATES.get(joint, (joint, 1.0))
        expected = factor * np.rad2deg(signals[f"{joint}.angle_rad"].to_numpy())
        np.testing.assert_allclose(columns[coordinate], expected, rtol=1e-10, atol=1e-10)


def test_signs_of_the_coordinates_are_those_of_the_motions() -> None:
    motions = {joint.name: joint.motion for joint in human().joints}
    for joint, (coordinate, factor) in COORDINATES.items():
        opposite = {"hip_adduction": "hip abduction", "arm_add": "shoulder abduction"}
        name = coordinate[:-2]
        assert factor == (-1.0 if name in opposite else 1.0)
        if name in opposite:
            assert motions[joint] == opposite[name]


def test_back_is_the_sum_of_its_joints(opensim_folder: Path, signals: pa.Table) -> None:
    _, columns = read_storage(opensim_folder / "angles.mot")
    spine = [joint for joints, _ in SPINE_COORDINATES.values() for joint in joints]
    assert len(spine) == len(set(spine)) == 10
    for coordinate, (joints, factor) in SPINE_COORDINATES.items():
        total = sum(signals[f"{joint}.angle_rad"].to_numpy() for joint in joints)
        np.testing.assert_allclose(columns[coordinate], factor * np.rad2deg(total), rtol=1e-10, atol=1e-10)


def test_pelvis_rotation_is_in_opensims_coordinates(opensim_folder: Path, signals: pa.Table) -> None:
    _, columns = read_storage(opensim_folder / "angles.mot")
    turns = np.deg2rad([columns[f"pelvis_{name}"] for name in ("tilt", "list", "rotation")]).T
    R_OP = Rotation.from_euler("ZXY", turns).as_matrix()
    quaternion = matrix(signals, [f"pelvis.quaternion_{axis}" for axis in "wxyz"])
    R_WP = Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
    # A vector forward, one up: the same in both worlds.
    for v_P in np.eye(3):
        np.testing.assert_allclose(R_OP @ (R_OW @ v_P), (R_WP @ v_P) @ R_OW.T, atol=1e-9)
    # Turning to the left is positive about an axis that points up.
    assert columns["pelvis_rotation"][-1] == pytest.approx(np.rad2deg(2 * 0.4), abs=2)


def test_pelvis_is_where_it_was_recorded(opensim_folder: Path, signals: pa.Table) -> None:
    _, columns = read_storage(opensim_folder / "angles.mot")
    x, y, z = matrix(signals, [f"pelvis.{axis}_m" for axis in "xyz"]).T
    for name, expected in zip(PELVIS_TRANSLATIONS, (x, z, -y), strict=True):
        np.testing.assert_allclose(columns[name], expected, atol=1e-9)


def test_opensims_world_is_x_forward_y_up_z_right() -> None:
    forward, left, up = np.eye(3)
    np.testing.assert_array_equal(R_OW @ forward, [1, 0, 0])
    np.testing.assert_array_equal(R_OW @ up, [0, 1, 0])
    np.testing.assert_array_equal(R_OW @ -left, [0, 0, 1])
    assert np.linalg.det(R_OW) == pytest.approx(1.0)


def test_clinical_angles_are_those_of_the_pelvis_from_exported_markers(opensim_folder: Path) -> None:
    """The pelvis as Plug-in Gait defines it: Y from the right to the left anterior spine, X in the plane with the
    middle of the posterior spines; rotation about the vertical, then obliquity, then tilt.
    """
    flags, columns = read_storage(opensim_folder / "clinical_angles.sto")
    assert flags["inDegrees"] == "yes"
    # From OpenSim's axes back to x forward, y left, z up.
    paths = {name: path @ R_OW for name, path in read_trc(opensim_folder / "markers.trc")[0].items()}
    left = paths["LASI"] - paths["RASI"]
    forward = paths["LASI"] + paths["RASI"] - paths["LPSI"] - paths["RPSI"]
    up = np.cross(forward, left)
    axes = np.stack([np.cross(left, up), left, up], axis=-1)
    turns = Rotation.from_matrix(axes / np.linalg.norm(axes, axis=1, keepdims=True)).as_euler("ZXY", degrees=True)
    for side, sign in (("r", 1.0), ("l", -1.0)):
        np.testing.assert_allclose(columns[f"pelvis_anterior_tilt_{side}"], turns[:, 2], atol=1e-4)
        np.testing.assert_allclose(columns[f"pelvis_up_obliquity_{side}"], -sign * turns[:, 1], atol=1e-4)
        np.testing.assert_allclose(columns[f"pelvis_internal_rotation_{side}"], sign * turns[:, 0], atol=1e-4)


def test_clinical_angles_and_coordinates_differ_by_the_tilt_of_the_pelvic_plane(opensim_folder: Path) -> None:
    _, clinical = read_storage(opensim_folder / "clinical_angles.sto")
    _, columns = read_storage(opensim_folder / "angles.mot")
    tilt = np.degrees(PELVIC_TILT)
    for side in "rl":
        np.testing.assert_allclose(clinical[f"hip_flexion_{side}"], columns[f"hip_flexion_{side}"] + tilt, atol=1e-8)
        np.testing.assert_allclose(clinical[f"knee_flexion_{side}"], columns[f"knee_angle_{side}"], atol=1e-8)
        np.testing.assert_allclose(clinical[f"ankle_dorsiflexion_{side}"], columns[f"ankle_angle_{side}"], atol=1e-8)
    # At the start the pelvis is level; its other rotations come in another order. OpenSim's tilt is positive backward.
    assert clinical["pelvis_anterior_tilt_r"][0] == pytest.approx(tilt - columns["pelvis_tilt"][0])


def test_torques_are_newton_meters_of_every_joint(opensim_folder: Path, signals: pa.Table) -> None:
    flags, columns = read_storage(opensim_folder / "torques.sto")
    assert flags["inDegrees"] == "no"
    assert len(columns) == 1 + 42
    for joint in joint_names(signals):
        coordinate, factor = COORDINATES.get(joint, (joint, 1.0))
        expected = factor * signals[f"{joint}.torque_N_m"].to_numpy()
        np.testing.assert_allclose(columns[f"{coordinate}_moment"], expected, rtol=1e-10, atol=1e-10)


def test_power_of_a_joint_is_the_same_in_both_programs(opensim_folder: Path, signals: pa.Table) -> None:
    """Angle and torque change their sign together."""
    _, angles = read_storage(opensim_folder / "angles.mot")
    _, torques = read_storage(opensim_folder / "torques.sto")
    for joint, (coordinate, _) in COORDINATES.items():
        product = signals[f"{joint}.torque_N_m"].to_numpy() * np.rad2deg(signals[f"{joint}.angle_rad"].to_numpy())
        np.testing.assert_allclose(torques[f"{coordinate}_moment"] * angles[coordinate], product, rtol=1e-9, atol=1e-9)


def test_ground_force_on_a_loaded_foot_is_the_recorded_one(run: Run) -> None:
    load, foot = ground_force(run, "Right"), "right_foot"
    loaded = run.signals[f"{foot}.loaded"].to_numpy() > 0.5
    for found, name in ((load.force, "force_*_N"), (load.point, "cop_*_m")):
        recorded = matrix(run.signals, [f"{foot}.{name.replace('*', axis)}" for axis in "xyz"])
        np.testing.assert_array_equal(found[loaded], recorded[loaded])
    np.testing.assert_array_equal(
        load.free_moment[loaded, 2], run.signals[f"{foot}.free_moment_N_m"].to_numpy()[loaded]
    )


@pytest.mark.parametrize("side", SIDES)
def test_ground_force_is_always_finite_and_zero_when_unloaded(run: Run, side: Side) -> None:
    load = ground_force(run, side)
    loaded = run.signals[f"{side.lower()}_foot.loaded"].to_numpy() > 0.5
    assert np.isfinite(np.column_stack((load.force, load.point, load.free_moment))).all()
    assert not load.force[~loaded].any()
    assert not load.free_moment[~loaded].any()


def test_point_of_an_unloaded_foot_is_interpolated_to_touchdown(run: Run) -> None:
    load = ground_force(run, "Right")
    loaded = run.signals["right_foot.loaded"].to_numpy() > 0.5
    x = load.point[:, 0]
    flight = np.flatnonzero(~loaded)
    assert (np.diff(x[flight[0] - 1 : flight[-1] + 2]) > 0).all()
    np.testing.assert_allclose(np.diff(x[flight], 2), 0, atol=1e-12)
    assert not ground_force(run, "Left").point.any()


def test_the_free_moment_is_about_the_normal_of_the_ground(run: Run, tmp_path: Path) -> None:
    scenario = replace(run.scenario, terrain=Plane(slope=0.3))
    sloped = Outcome(scenario, run.signals, "completed", 1.0).write(tmp_path, "made up")
    recorded = run.signals["right_foot.free_moment_N_m"].to_numpy()
    normal = (-np.sin(0.3), 0.0, np.cos(0.3))
    np.testing.assert_allclose(ground_force(sloped, "Right").free_moment, np.outer(recorded, normal), atol=1e-12)


def test_external_loads_carry_the_wrench_of_each_foot(opensim_folder: Path, run: Run) -> None:
    """The moment about the origin, which must not depend on how it is written."""
    _, columns = read_storage(opensim_folder / "ground_forces.mot")
    assert all(np.isfinite(column).all() for column in columns.values())
    for side in SIDES:
        letter = side[0].lower()
        force, point, torque = (
            np.column_stack([columns[f"{name}{axis}"] for axis in "xyz"]) @ R_OW
            for name in (f"ground_force_{letter}_v", f"ground_force_{letter}_p", f"ground_torque_{letter}_")
        )
        load = ground_force(run, side)
        np.testing.assert_allclose(force, load.force, atol=1e-8)
        expected = np.cross(load.point, load.force) + load.free_moment
        np.testing.assert_allclose(np.cross(point, force) + torque, expected, atol=1e-8)


def test_external_loads_xml_names_existing_columns(opensim_folder: Any) -> None:
    root = ET.parse(opensim_folder / "external_loads.xml").getroot()
    _, columns = read_storage(opensim_folder / root.findtext(".//datafile"))
    forces = root.findall(".//ExternalForce")
    assert [force.findtext("applied_to_body") for force in forces] == ["calcn_r", "calcn_l"]
    for force in forces:
        for kind in ("force", "point", "torque"):
            prefix = force.findtext(f"{kind}_identifier")
            assert all(f"{prefix}{axis}" in columns for axis in "xyz")


def test_markers_are_millimeters_in_opensims_axes(opensim_folder: Path, run: Run, signals: pa.Table) -> None:
    paths, time, head = read_trc(opensim_folder / "markers.trc")
    assert head["Units"] == "mm"
    assert float(head["DataRate"]) == 200
    np.testing.assert_allclose(time, signals[TIME].to_numpy(), atol=1e-9)
    for name, path in marker_paths(run).items():
        np.testing.assert_allclose(paths[name], 1000 * path @ R_OW.T, atol=1e-5)


def test_markers_keep_their_distances_on_a_body(run: Run) -> None:
    paths = marker_paths(run)
    skeleton = run.scenario.subject.skeleton
    assert list(paths) == [marker.name for marker in markers(skeleton)]
    on_body = {marker.name: marker for marker in markers(skeleton)}
    for a, b in (("LASI", "RPSI"), ("RKNE", "RTHI"), ("LFHD", "RBHD"), ("RTOE", "RMT5")):
        expected = np.linalg.norm(np.subtract(on_body[a].position, on_body[b].position))
        np.testing.assert_allclose(np.linalg.norm(paths[a] - paths[b], axis=1), expected, rtol=1e-9)


def test_csv_keeps_every_number(run: Run, signals: pa.Table) -> None:
    (path,) = export_run(run, "csv")
    with path.open() as file:
        names, *rows = csv.reader(file)
    assert names == signals.column_names
    np.testing.assert_array_equal(np.array(rows, dtype=float), matrix(signals, names))


def test_mat_keeps_every_number(run: Run, signals: pa.Table) -> None:
    (path,) = export_run(run, "mat")
    read = loadmat(path, simplify_cells=True)
    np.testing.assert_array_equal(read["signals"][TIME], signals[TIME].to_numpy())
    found = 1
    for thing, quantities in read["signals"].items():
        if isinstance(quantities, dict):
            for quantity, values in quantities.items():
                np.testing.assert_array_equal(values, signals[f"{thing}.{quantity}"].to_numpy())
                found += 1
    assert found == len(signals.column_names)
    assert "stature: 1.68" in read["scenario"]


def test_export_prints_its_files_and_writes_into_the_given_folder(run: Run, tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["export", str(run.path), "--to", "csv", "-o", str(tmp_path / "out")])
    assert result.exit_code == 0, result.output
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["signals.csv"]


def test_files_of_another_are_replaced_only_with_overwrite(run: Run, tmp_path: Path) -> None:
    (tmp_path / "signals.csv").write_text("mine")
    with pytest.raises(ParameterError, match=r"signals.csv: is there already; allowed: .* --overwrite"):
        export_run(run, "csv", tmp_path)
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]
    (written,) = export_run(run, "csv", tmp_path, overwrite=True)
    assert written.read_text() != "mine"
    # Those in the run's folder are our own.
    assert export_run(run, "csv") == export_run(run, "csv")


def test_a_folder_in_the_place_of_our_own_file_is_to_be_moved(run: Run, tmp_path: Path) -> None:
    """The user has named no file with -o."""
    copy = shutil.copytree(run.path, tmp_path / "run", ignore=shutil.ignore_patterns("csv"))
    folder = copy / "csv" / "signals.csv"
    folder.mkdir(parents=True)
    with pytest.raises(ParameterError, match=rf"^{folder}: a folder or device; allowed: a file; move it away$"):
        export_run(Run.open(copy), "csv")


def test_unknown_format_is_refused(run: Run, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="allowed: opensim, c3d, csv, mat"):
        export_run(run, "opensm", tmp_path)
    assert set(FORMATS) == {"opensim", "c3d", "csv", "mat"}


def test_a_run_with_more_frames_than_c3d_counts_is_refused(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("humanwalk.exchange.c3d.MAX_FRAMES", run.time.size - 1)
    with pytest.raises(ParameterError, match=r"samples; allowed in C3D: up to \d+; export csv or mat"):
        export_run(run, "c3d", tmp_path)
    assert not list(tmp_path.glob("*.c3d"))


def test_csv_has_no_cell_that_a_spreadsheet_executes(run: Run, signals: pa.Table, tmp_path: Path) -> None:
    """A spreadsheet takes text that begins with one of =+-@ for a formula; only numbers may be negative."""
    (path,) = export_run(run, "csv", tmp_path / "out")
    with path.open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    assert [name for name in names if not name[0].isalpha()] == []
    assert all(np.isfinite(float(cell)) for row in rows for cell in row)
    # A run folder of somebody else is not read when a column has such a name.
    folder = shutil.copytree(run.path, tmp_path / "hostile")
    column = signals.column_names[5]
    hostile = signals.rename_columns([f"=cmd|' /C calc'!A0.{name}" if name == column else name for name in names])
    pq.write_table(hostile, folder / SIGNALS)
    with pytest.raises(ParameterError):
        export_run(Run.open(folder), "csv", tmp_path / "out")


@pytest.mark.parametrize("to", FORMATS)
def test_forces_that_a_format_does_not_contain_are_named(run: Run, to: str) -> None:
    """The body of the made-up run is held upright and pushed."""
    assert forces_left_out(run, to) == (("EXTERNAL SUPPORT", "pushes") if to in ("opensim", "c3d") else ())


def test_pushes_that_were_not_recorded_are_not_named(run: Run) -> None:
    unpushed = Run(run.path)
    unpushed.__dict__["signals"] = run.signals.drop_columns(list(FORCE_COLUMNS))
    assert forces_left_out(unpushed, "opensim") == ("EXTERNAL SUPPORT",)
