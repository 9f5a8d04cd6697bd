"""A run for OpenSim: angles, torques, ground reaction forces as external loads, markers, and clinical angles.

Axes are OpenSim's: x forward, y up, z right. Joints are named and signed as in the full-body model of Rajagopal et al.
(2016), see `humanwalk.body.opensim_names`. Joints absent from that model keep their names; OpenSim ignores them. As in
that model, hip and pelvis angles of `angles.mot` are zero in upright standing; the clinical ones, of the pelvic plane,
are in `clinical_angles.sto`.
"""

import io
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from humanwalk.body import SIDES
from humanwalk.body.opensim_names import COORDINATES, PELVIS_ROTATIONS, PELVIS_TRANSLATIONS, R_OW, SPINE_COORDINATES
from humanwalk.exchange.motion import ground_forces, marker_paths, sample_rate
from humanwalk.files import write_text
from humanwalk.measures.curves import ANGLES
from humanwalk.measures.effort import joint_names
from humanwalk.measures.path import path_directions
from humanwalk.measures.signals import TIME, matrix
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.numerics import Array
from humanwalk.run.folder import Run

EXTERNAL_LOADS = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000">
	<ExternalLoads name="external_loads">
		<objects>
{forces}		</objects>
		<datafile>ground_forces.mot</datafile>
	</ExternalLoads>
</OpenSimDocument>
"""
EXTERNAL_FORCE = """			<ExternalForce name="{side}_foot">
				<applied_to_body>calcn_{letter}</applied_to_body>
				<force_expressed_in_body>ground</force_expressed_in_body>
				<point_expressed_in_body>ground</point_expressed_in_body>
				<force_identifier>ground_force_{letter}_v</force_identifier>
				<point_identifier>ground_force_{letter}_p</point_identifier>
				<torque_identifier>ground_torque_{letter}_</torque_identifier>
			</ExternalForce>
"""


def write_opensim(run: Run, folder: Path) -> list[Path]:
    """Write angles.mot, clinical_angles.sto, torques.sto, ground_forces.mot, external_loads.xml and markers.trc."""
    loads = "".join(EXTERNAL_FORCE.format(side=side.lower(), letter=side[0].lower()) for side in SIDES)
    texts = {
        "angles.mot": storage_text("Coordinates", angles(run)),
        "clinical_angles.sto": storage_text("Clinical angles", clinical_angles(run)),
        "torques.sto": storage_text("Actuator torques", torques(run)),
        "ground_forces.mot": storage_text("Ground forces", external_loads(run)),
        "external_loads.xml": EXTERNAL_LOADS.format(forces=loads),
        "markers.trc": trc_text("markers.trc", marker_paths(run), run.signals[TIME].to_numpy(), sample_rate(run)),
    }
    for name, text in texts.items():
        write_text(folder / name, text)
    return [folder / name for name in texts]


def angles(run: Run) -> MotionTable:
    """Position [m] and orientation [deg] of the pelvis, and the angle of every joint and of the back [deg]."""
    signals = run.signals
    quaternion = matrix(signals, [f"pelvis.quaternion_{axis}" for axis in "wxyz"])
    R_WP = Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
    # Both frames are rotated: at rest OpenSim's pelvis is parallel to its ground, as ours is to W.
    turns = Rotation.from_matrix(R_OW @ R_WP @ R_OW.T).as_euler("ZXY")
    columns: dict[str, Array] = {
        name: np.rad2deg(np.unwrap(turn)) for name, turn in zip(PELVIS_ROTATIONS, turns.T, strict=True)
    }
    place = matrix(signals, [f"pelvis.{axis}_m" for axis in "xyz"]) @ R_OW.T
    columns |= zip(PELVIS_TRANSLATIONS, place.T, strict=True)
    own = {name: np.rad2deg(signals[f"{name}.angle_rad"].to_numpy()) for name in joint_names(signals)}
    for name, angle in own.items():
        coordinate, factor = COORDINATES.get(name, (name, 1.0))
        columns[coordinate] = factor * angle
    for coordinate, (joints, factor) in SPINE_COORDINATES.items():
        columns[coordinate] = factor * np.sum([own[joint] for joint in joints], axis=0)
    return _table(run, columns, in_degrees=True)


def clinical_angles(run: Run) -> MotionTable:
    """The angles of a gait report (`humanwalk.measures.curves.ANGLES`) of both legs [deg]: hip_flexion_r and so on.

    Rotation of the pelvis and foot progression are relative to the heading of the commanded path.
    """
    mass, facing = run.scenario.subject.mass, path_directions(run.signals, run.scenario.controller.command).facing
    columns = {
        f"{angle.quantity.removesuffix('_deg')}_{side[0].lower()}": angle.of(run.signals, side, mass, facing)
        for side in SIDES
        for angle in ANGLES.values()
    }
    return _table(run, columns, in_degrees=True)


def torques(run: Run) -> MotionTable:
    """Torque of every joint's actuator [N m], under the name of its coordinate with `_moment`."""
    columns = {}
    for name in joint_names(run.signals):
        coordinate, factor = COORDINATES.get(name, (name, 1.0))
        columns[f"{coordinate}_moment"] = factor * run.signals[f"{name}.torque_N_m"].to_numpy()
    return _table(run, columns, in_degrees=False)


def external_loads(run: Run) -> MotionTable:
    """Force [N], point [m] and torque [N m] of the ground on each foot; see `GroundForce`."""
    columns: dict[str, Array] = {}
    for side, load in ground_forces(run).items():
        letter = side[0].lower()
        vectors = {
            f"force_{letter}_v": load.force,
            f"force_{letter}_p": load.point,
            f"torque_{letter}_": load.free_moment,
        }
        for name, vector in vectors.items():
            columns |= zip([f"ground_{name}{axis}" for axis in "xyz"], (vector @ R_OW.T).T, strict=True)
    return _table(run, columns, in_degrees=False)


def trc_text(file_name: str, paths: dict[str, Array], time: Array, rate: float) -> str:
    """Marker paths in W [m] as the text of a TRC file: millimeters, OpenSim's axes."""
    rows = time.size
    text = io.StringIO()
    text.write(f"PathFileType\t4\t(X/Y/Z)\t{file_name}\n")
    text.write("DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n")
    text.write(f"{rate:.10g}\t{rate:.10g}\t{rows}\t{len(paths)}\tmm\t{rate:.10g}\t1\t{rows}\n")
    text.write("Frame#\tTime\t" + "\t\t\t".join(paths) + "\t\t\n")
    text.write("\t\t" + "\t".join(f"{axis}{i}" for i in range(1, len(paths) + 1) for axis in "XYZ") + "\n\n")
    data = np.column_stack([time, *(1000.0 * path @ R_OW.T for path in paths.values())])
    for i, row in enumerate(data):
        text.write(f"{i + 1}\t" + "\t".join(f"{value:.10g}" for value in row) + "\n")
    return text.getvalue()


def _table(run: Run, columns: dict[str, Array], in_degrees: bool) -> MotionTable:
    # Turns -0 into 0.
    data = np.column_stack(list(columns.values())) + 0.0
    return MotionTable(tuple(columns), run.signals[TIME].to_numpy(), data, in_degrees)
