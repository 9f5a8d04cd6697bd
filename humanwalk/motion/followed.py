"""A recording as motion of a subject's body: columns to joints, units to SI, feet on the ground."""

import logging
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context

from humanwalk.body import contact_spheres
from humanwalk.body.joint_map import JointMap, pelvis_pose
from humanwalk.body.limbs import LEGS
from humanwalk.body.opensim_names import COORDINATES, PELVIS_ROTATIONS, PELVIS_TRANSLATIONS, R_OW, SPINE_COORDINATES
from humanwalk.body.plant import kinematics_plant, sole_points
from humanwalk.body.subject import Subject
from humanwalk.motion.motion_table import MotionTable, brief, first_names, read_motion_table
from humanwalk.motion.recorded_motion import MotionMapping, RecordedMotion, pelvis_rotation
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, did_you_mean, printable
from humanwalk.terrain import Terrain

logger = logging.getLogger(__name__)

REQUIRED_JOINTS = tuple(joint for leg in LEGS.values() for joint in (*leg.hip, leg.knee, leg.ankle))
"""Joints that every recording of a walk must have. Every other joint stays at zero unless it is recorded."""

RANGE_TOLERANCE = 0.1
"""Largest excess of a recorded angle over the joint's range that is clipped rather than refused [rad]."""

MIN_REPORTED_CLIP = 0.01
"""Smallest clipped excess that is logged [deg]: a file's last digits may be truncated."""

MAX_PELVIS_ANGLE = 1000.0
MAX_PELVIS_POSITION = 10_000.0
"""Largest recorded angle [rad] and coordinate [m] of the pelvis."""

MAX_PELVIS_SPEED = 10.0
"""Largest recorded speed of the pelvis [m/s]: that of a sprinter. A walk in millimeters is faster."""

METERS = {"m": 1.0, "cm": 0.01, "mm": 0.001}


def followed_motion(
    file: Path, mapping: MotionMapping, subject: Subject, terrain: Terrain, ease_in: float
) -> RecordedMotion:
    """Read a recording as motion of a body, joints in actuator order, feet on the ground at the start.

    The pelvis path is the recorded one, translated so that it starts above the origin with the lowest point of the
    soles on the ground. Without a recorded path the pelvis stays upright and moves so that the lowest point of the
    soles, which stands still on the ground, does not slide.

    Angles beyond a joint's range by up to RANGE_TOLERANCE are clipped, with a warning in the log. Columns that are not
    used are named there too.

    Args:
        file: See `read_motion_table`.
        mapping: Which column is which joint.
        subject: The body.
        terrain: The ground.
        ease_in: Time over which the recording gets up to speed [s].

    Raises:
        ParameterError: The recording or its mapping cannot be used; one line with the fix.
    """
    columns = _Columns(read_motion_table(file), mapping, printable(file))
    plant = kinematics_plant(subject)
    joints = JointMap.of(plant)
    _require_known("columns", mapping.columns, joints.names, (*PELVIS_ROTATIONS, *PELVIS_TRANSLATIONS))
    _require_known("hold", mapping.hold, joints.names, ())
    angles, pelvis_angles, position = columns.joints(joints), columns.pelvis_angles(), columns.pelvis_position()
    columns.report_unused()
    body = _Body(plant, subject, joints)
    if position is None:
        position = _stance_path(body, terrain, angles, pelvis_angles)
    else:
        soles = body.sole_points(angles[0], pelvis_angles[0])
        position = position - position[0]
        position[:, 2] -= np.min(soles[:, 2] - terrain.height(soles[:, :2]))
    time = columns.table.time
    return RecordedMotion(time - time[0], angles, pelvis_angles, position, ease_in)


def _require_known(field: str, names: Iterable[str], joints: Sequence[str], pelvis: Sequence[str]) -> None:
    """Raise ParameterError for a name in a field of the mapping that is no joint and no coordinate of the pelvis."""
    for name in names:
        if name not in (*joints, *pelvis):
            raise ParameterError(
                f"mapping: {field}.{brief(name)}: no such joint; allowed: "
                f"{', '.join((f'the {len(joints)} joints of the body', *pelvis))}"
                f"{did_you_mean(brief(name), (*joints, *pelvis)) or '; correct it'}"
            )


class _Columns:
    """Columns of a recording as joint angles and pelvis path, in SI units."""

    def __init__(self, table: MotionTable, mapping: MotionMapping, file: str) -> None:
        self.table, self._mapping, self._file = table, mapping, file
        self._used: set[str] = set()

    def joints(self, joints: JointMap) -> Array:
        """Angles of all joints [rad], shape (rows, n), within their ranges."""
        spine = self._spine()
        angles = np.zeros((self.table.time.size, len(joints.names)))
        missing = []
        for i, name in enumerate(joints.names):
            if name in self._mapping.hold:
                angles[:, i] = self._mapping.hold[name]
                self._used.update(self._candidates(name))
                continue
            found = self._angle(name, self._candidates(name), COORDINATES.get(name, ("", 1.0))[1])
            if found is not None:
                angles[:, i] = found
            elif name in spine:
                angles[:, i] = spine[name]
            elif name in REQUIRED_JOINTS:
                missing.append(name)
        if missing:
            raise ParameterError(
                f"{self._file}: no column for {', '.join(missing)}; found: {first_names(self.table.columns)}; name "
                f"the columns {missing[0]} or {COORDINATES[missing[0]][0]}, or map them in --mapping "
                f"(columns: {{{missing[0]}: {{column: ...}}}}), or keep them constant (hold: {{{missing[0]}: 0}})"
            )
        return self._within_range(joints, angles)

    def pelvis_angles(self) -> Array:
        """Pitch, roll, yaw [rad], shape (rows, 3); zero where they are not recorded."""
        angles = np.zeros((self.table.time.size, 3))
        # OpenSim's tilt is about an axis to the right.
        for i, (name, sign) in enumerate(zip(PELVIS_ROTATIONS, (-1.0, 1.0, 1.0), strict=True)):
            found = self._angle(name, _spellings(name), 1.0)
            if found is not None:
                angles[:, i] = sign * np.unwrap(self._bounded(name, found, MAX_PELVIS_ANGLE, "rad"))
        return angles

    def pelvis_position(self) -> Array | None:
        """p_WP [m], shape (rows, 3), or None where it is not recorded."""
        present = [values for values in map(self._length, PELVIS_TRANSLATIONS) if values is not None]
        if not present:
            return None
        if len(present) < 3:
            raise ParameterError(
                f"{self._file}: only some of {', '.join(PELVIS_TRANSLATIONS)} are present; allowed: all three or none; "
                "add or remove columns"
            )
        position: Array = np.column_stack(present) @ R_OW
        self._bounded("pelvis path", position, MAX_PELVIS_POSITION, "m")
        speed = np.linalg.norm(np.diff(position, axis=0), axis=1) / np.diff(self.table.time)
        row = int(np.argmax(speed))
        if speed[row] > MAX_PELVIS_SPEED:
            raise ParameterError(
                f"{self._file}: {', '.join(PELVIS_TRANSLATIONS)} move at {speed[row]:.3g} m/s at "
                f"{self.table.time[row]:g} s; allowed: up to {MAX_PELVIS_SPEED:g} m/s; check their unit "
                "(length_unit: mm) in --mapping, and close jumps"
            )
        return position

    def _length(self, name: str) -> Array | None:
        """A translation of the pelvis [m], or None; its unit is that in the column's name, else that of the mapping."""
        named = {f"{name}_{unit}": length for unit, length in METERS.items()}
        found = self._values(name, [name, *named])
        if found is None:
            return None
        values, column = found
        unit = METERS[self._mapping.length_unit]
        return values * (unit if name in self._mapping.columns else named.get(column, unit))

    def _candidates(self, joint: str) -> list[str]:
        coordinate = _spellings(COORDINATES[joint][0]) if joint in COORDINATES else []
        return [f"{joint}.angle_rad", f"{joint}.angle_deg", *_spellings(joint), *coordinate]

    def _spine(self) -> Mapping[str, Array]:
        """OpenSim's single joint of the back, distributed evenly over the joints that it represents."""
        parts: dict[str, Array] = {}
        for coordinate, (joints, factor) in SPINE_COORDINATES.items():
            found = self._angle(coordinate, _spellings(coordinate), 1.0)
            if found is not None:
                parts |= dict.fromkeys(joints, found / (factor * len(joints)))
        return parts

    def _values(self, name: str, candidates: list[str]) -> tuple[Array, str] | None:
        """Recorded values of a joint, scaled by the mapping, and the name of their column."""
        mapped = self._mapping.columns.get(name)
        if mapped is None:
            column = next((candidate for candidate in candidates if candidate in self.table.columns), None)
            if column is None:
                return None
            self._used.add(column)
            return self.table.column(column), column
        if mapped.column not in self.table.columns:
            column = brief(mapped.column)
            raise ParameterError(
                f"{self._file}: no column {column}, which the mapping has for {name}; found: "
                f"{first_names(self.table.columns)}{did_you_mean(column, [*map(brief, self.table.columns)])}"
            )
        self._used.add(mapped.column)
        return mapped.scale * self.table.column(mapped.column) + mapped.offset, mapped.column

    def _angle(self, name: str, candidates: list[str], factor: float) -> Array | None:
        """An angle [rad], or None; `factor` applies to OpenSim's coordinates."""
        found = self._values(name, candidates)
        if found is None:
            return None
        values, column = found
        if name not in self._mapping.columns and column in _spellings(COORDINATES.get(name, ("",))[0]):
            values = factor * values
        return np.deg2rad(values) if self._in_degrees(column) else values

    def _in_degrees(self, column: str) -> bool:
        if self._mapping.angle_unit != "auto":
            return self._mapping.angle_unit == "deg"
        for unit in ("deg", "rad"):
            if column.endswith(f"_{unit}"):
                return unit == "deg"
        if self.table.in_degrees is None:
            raise ParameterError(
                f"{self._file}: column {brief(column)}: unknown angle unit; allowed: a name that ends in _deg or _rad; "
                "rename it, or set angle_unit: deg in --mapping"
            )
        return self.table.in_degrees

    def report_unused(self) -> None:
        """Log the columns that no joint and no coordinate of the pelvis was read from."""
        unused = [column for column in self.table.columns if column not in self._used]
        if unused:
            logger.warning("%s: columns that are not used: %s", self._file, first_names(unused))

    def _within_range(self, joints: JointMap, angles: Array) -> Array:
        """The angles, clipped to the joints' ranges where they exceed them by up to RANGE_TOLERANCE."""
        excess = np.maximum(joints.lower - angles, angles - joints.upper)
        row, i = np.unravel_index(int(np.argmax(excess)), excess.shape)
        if excess[row, i] > RANGE_TOLERANCE:
            raise ParameterError(
                f"{self._file}: {joints.names[i]} is {angles[row, i]:.3g} rad ({np.rad2deg(angles[row, i]):.4g} deg) "
                f"at {self.table.time[row]:g} s; allowed: {joints.lower[i]:.3g} to {joints.upper[i]:.3g} rad; "
                "check the unit (angle_unit) and the sign (scale: -1) in --mapping"
            )
        largest = np.rad2deg(excess.max(axis=0))
        reported = [i for i in np.argsort(-largest) if largest[i] > MIN_REPORTED_CLIP]
        clipped = [f"{joints.names[i]} by up to {largest[i]:.2g} deg" for i in reported]
        if clipped:
            logger.warning("%s: angles clipped to the range of their joints: %s", self._file, ", ".join(clipped))
        return np.clip(angles, joints.lower, joints.upper)

    def _bounded(self, name: str, values: Array, limit: float, unit: str) -> Array:
        largest = float(np.abs(values).max())
        if largest > limit:
            raise ParameterError(
                f"{self._file}: {name} reaches {largest:.3g} {unit}; allowed: up to {limit:g} {unit}; check the unit "
                "and the scale in --mapping"
            )
        return values


def _spellings(angle: str) -> list[str]:
    """Names of the column of an angle: without a unit, or with one."""
    return [angle, f"{angle}_deg", f"{angle}_rad"]


class _Body:
    """A body whose pelvis origin is at Wo."""

    def __init__(self, plant: MultibodyPlant, subject: Subject, joints: JointMap) -> None:
        self._plant, self._joints = plant, joints
        self._context: Context = plant.CreateDefaultContext()
        self._pelvis = pelvis_pose(plant)
        self._spheres = contact_spheres(subject.skeleton)

    def sole_points(self, angles: Array, pelvis_angles: Array) -> Array:
        """Lowest points of the contact spheres relative to the pelvis, in W [m], shape (spheres, 3)."""
        q = self._plant.GetPositions(self._context)
        q[self._joints.q] = angles
        q[self._pelvis] = [*pelvis_rotation(pelvis_angles).ToQuaternion().wxyz(), 0.0, 0.0, 0.0]
        self._plant.SetPositions(self._context, q)
        return sole_points(self._plant, self._context, self._spheres)


def _stance_path(body: _Body, terrain: Terrain, angles: Array, pelvis_angles: Array) -> Array:
    """Pelvis path [m], shape (rows, 3), for which the sole point nearest the ground does not slide between rows."""
    position = np.zeros((angles.shape[0], 3))
    stance, p_WStance = 0, np.zeros(2)
    for row in range(angles.shape[0]):
        points = body.sole_points(angles[row], pelvis_angles[row])
        if row > 0:
            position[row, :2] = p_WStance - points[stance, :2]
        height = points[:, 2] - terrain.height(position[row, :2] + points[:, :2])
        stance = int(np.argmin(height))
        position[row, 2] = -height[stance]
        p_WStance = position[row, :2] + points[stance, :2]
    return position
