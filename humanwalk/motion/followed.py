"""The recording that a scenario follows, as a motion of the scenario's body."""

import difflib
import logging
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context

from humanwalk.body import LEG_JOINTS, SIDES, contact_spheres
from humanwalk.body.joint_map import JointMap
from humanwalk.body.opensim_names import (
    COORDINATES,
    PELVIS_ROTATIONS,
    PELVIS_TRANSLATIONS,
    R_OW,
    SPINE_COORDINATES,
)
from humanwalk.body.plant import Subject, kinematics_plant
from humanwalk.motion.motion_table import MotionTable, nearest_names, read_motion_table
from humanwalk.motion.recorded_motion import MotionMapping, RecordedMotion, pelvis_rotation
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_as

logger = logging.getLogger(__name__)

NEEDED = tuple(name for side in SIDES for name in LEG_JOINTS[side][:5])
"""Joints without which it is no walk: hips, knees, ankles. Every other joint stays at zero unless it is recorded."""

RANGE_TOLERANCE = 0.1
"""How far a recorded angle may lie beyond the joint's range; it is then moved to its end [rad]."""

LEAST_TOLD = 0.01
"""Of an angle that is moved, the least that is told [deg]: a file's digits may be cut off."""

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}


def followed_motion(scenario: Scenario) -> RecordedMotion:
    """The recording of `scenario.follow`, joints in actuator order, feet on the ground at the start.

    The pelvis' path is the recorded one, moved so that it starts above the origin with the lowest point of the soles
    on the ground. Without a recorded one the pelvis stays upright, and goes where the lowest point of the soles,
    standing still on the ground, carries it.

    Angles a little beyond a joint's range are moved to its end, which the log tells in a line.

    Raises:
        ParameterError: the recording or its mapping cannot be used, with a mend.
    """
    table = read_motion_table(Path(scenario.follow.file))
    mapping = load_as(MotionMapping, Path(scenario.follow.mapping)) if scenario.follow.mapping else MotionMapping()
    plant = kinematics_plant(scenario.subject)
    joints = JointMap.of(plant)
    columns = _Columns(table, mapping, scenario.follow.file)
    for name in (*mapping.columns, *mapping.hold):
        if name not in (*joints.names, *PELVIS_ROTATIONS, *PELVIS_TRANSLATIONS):
            raise ParameterError(
                f"{scenario.follow.mapping}: {name}: no such joint; allowed: the 42 joints of the body and "
                f"{', '.join((*PELVIS_ROTATIONS, *PELVIS_TRANSLATIONS))}{_did_you_mean(name, joints.names)}"
            )
    angles = columns.joints(joints)
    turns, place = columns.pelvis_turns(), columns.pelvis_place()
    if place is None:
        place = _carried_by_the_feet(plant, scenario.subject, joints, angles, turns)
    else:
        context = plant.CreateDefaultContext()
        _set(plant, context, joints, angles[0], turns[0], place[0])
        place = place - [*place[0, :2], _sole_points(plant, context, scenario.subject)[:, 2].min()]
    return RecordedMotion(table.time - table.time[0], angles, turns, place, scenario.follow.ease_in)


class _Columns:
    """What a recording says of joints and pelvis, in SI units."""

    def __init__(self, table: MotionTable, mapping: MotionMapping, file: str) -> None:
        self._table, self._mapping, self._file = table, mapping, file

    def joints(self, joints: JointMap) -> Array:
        """Angles of all joints [rad], shape (rows, n), within their ranges."""
        spine = self._spine()
        angles = np.zeros((self._table.time.size, len(joints.names)))
        missing = []
        for i, name in enumerate(joints.names):
            found = self._angle(name, self._names(name), COORDINATES.get(name, ("", 1.0))[1])
            if name in self._mapping.hold:
                angles[:, i] = self._mapping.hold[name]
            elif found is not None:
                angles[:, i] = found
            elif name in spine:
                angles[:, i] = spine[name]
            elif name in NEEDED:
                missing.append(name)
        if missing:
            raise ParameterError(
                f"{self._file}: no column for {', '.join(missing)}; found: {nearest_names(self._table.columns)}; name "
                f"the columns {missing[0]} or {COORDINATES[missing[0]][0]}, or say in --mapping which they are "
                f"(columns: {{{missing[0]}: {{column: ...}}}}) or that they stay (hold: {{{missing[0]}: 0}})"
            )
        return self._within_range(joints, angles)

    def pelvis_turns(self) -> Array:
        """Pitch, roll, yaw [rad], shape (rows, 3); zero where they are not recorded."""
        turns = np.zeros((self._table.time.size, 3))
        # OpenSim's tilt is about an axis to the right.
        for i, (name, sign) in enumerate(zip(PELVIS_ROTATIONS, (-1.0, 1.0, 1.0), strict=True)):
            found = self._angle(name, [name], 1.0)
            if found is not None:
                turns[:, i] = sign * np.unwrap(found)
        return turns

    def pelvis_place(self) -> Array | None:
        """Place of the pelvis in W [m], shape (rows, 3), or None where it is not recorded."""
        found = [self._values(name, [name]) for name in PELVIS_TRANSLATIONS]
        present = [values for values, _ in (pair for pair in found if pair is not None)]
        if not present:
            return None
        if len(present) < 3:
            raise ParameterError(
                f"{self._file}: only some of {', '.join(PELVIS_TRANSLATIONS)} are there; allowed: all three or none; "
                "record the others, or remove them"
            )
        place: Array = METRES[self._mapping.length_unit] * np.column_stack(present) @ R_OW
        return place

    def _names(self, joint: str) -> list[str]:
        coordinate = [COORDINATES[joint][0]] if joint in COORDINATES else []
        return [f"{joint}.angle_rad", f"{joint}.angle_deg", joint, *coordinate]

    def _spine(self) -> Mapping[str, Array]:
        """OpenSim's one joint of the back shared out evenly over the joints that it stands for."""
        shares: dict[str, Array] = {}
        for coordinate, (joints, factor) in SPINE_COORDINATES.items():
            found = self._angle(coordinate, [coordinate], 1.0)
            if found is not None:
                shares |= dict.fromkeys(joints, found / (factor * len(joints)))
        return shares

    def _values(self, name: str, candidates: list[str]) -> tuple[Array, str] | None:
        """Numbers of a joint as recorded, scaled as the mapping says, and the column that they are in."""
        mapped = self._mapping.columns.get(name)
        if mapped is None:
            column = next((candidate for candidate in candidates if candidate in self._table.columns), None)
            return None if column is None else (self._table.column(column), column)
        if mapped.column not in self._table.columns:
            raise ParameterError(
                f"{self._file}: no column {mapped.column!r}, which the mapping wants for {name}; found: "
                f"{nearest_names(self._table.columns)}{_did_you_mean(mapped.column, self._table.columns)}"
            )
        return mapped.scale * self._table.column(mapped.column) + mapped.offset, mapped.column

    def _angle(self, name: str, candidates: list[str], factor: float) -> Array | None:
        """An angle [rad], or None; `factor` applies to OpenSim's coordinates."""
        found = self._values(name, candidates)
        if found is None:
            return None
        values, column = found
        if name not in self._mapping.columns and column == COORDINATES.get(name, ("",))[0]:
            values = factor * values
        return np.deg2rad(values) if self._in_degrees(column) else values

    def _in_degrees(self, column: str) -> bool:
        if self._mapping.angle_unit != "auto":
            return self._mapping.angle_unit == "deg"
        for unit in ("deg", "rad"):
            if column.endswith(f"_{unit}"):
                return unit == "deg"
        if self._table.in_degrees is None:
            raise ParameterError(
                f"{self._file}: column {column}: in degrees or radians? allowed: a name that ends in _deg or _rad; "
                "rename it, or write angle_unit: deg in --mapping"
            )
        return self._table.in_degrees

    def _within_range(self, joints: JointMap, angles: Array) -> Array:
        """The angles, each moved to the end of its joint's range where it is beyond by up to RANGE_TOLERANCE."""
        beyond = np.maximum(joints.lower - angles, angles - joints.upper)
        row, i = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
        if beyond[row, i] > RANGE_TOLERANCE:
            raise ParameterError(
                f"{self._file}: {joints.names[i]} is {angles[row, i]:.3g} rad ({np.rad2deg(angles[row, i]):.0f} deg) "
                f"at {self._table.time[row]:g} s; allowed: {joints.lower[i]:.3g} to {joints.upper[i]:.3g} rad; "
                "check the unit (angle_unit) and the sign (scale: -1) in --mapping"
            )
        most = np.rad2deg(beyond.max(axis=0))
        moved = [f"{joints.names[i]} by up to {most[i]:.2g} deg" for i in np.argsort(-most) if most[i] > LEAST_TOLD]
        if moved:
            logger.warning("%s: beyond the range of joints, moved to its end: %s", self._file, ", ".join(moved))
        return np.clip(angles, joints.lower, joints.upper)


def _carried_by_the_feet(
    plant: MultibodyPlant, subject: Subject, joints: JointMap, angles: Array, turns: Array
) -> Array:
    """Path of a pelvis whose feet do not slide: from row to row the lowest point of the soles stays where it is."""
    context = plant.CreateDefaultContext()
    place = np.zeros((angles.shape[0], 3))
    standing, held = 0, np.zeros(3)
    for row in range(angles.shape[0]):
        _set(plant, context, joints, angles[row], turns[row], np.zeros(3))
        points = _sole_points(plant, context, subject)
        if row > 0:
            place[row] = held - points[standing]
        standing = int(np.argmin(points[:, 2]))
        place[row, 2] = -points[standing, 2]
        held = place[row] + points[standing]
    return place


def _set(plant: MultibodyPlant, context: Context, joints: JointMap, angles: Array, turns: Array, place: Array) -> None:
    q = plant.GetPositions(context)
    q[joints.q] = angles
    start = plant.GetBodyByName("Pelvis").floating_positions_start()
    q[start : start + 7] = [*pelvis_rotation(turns).ToQuaternion().wxyz(), *place]
    plant.SetPositions(context, q)


def _sole_points(plant: MultibodyPlant, context: Context, subject: Subject) -> Array:
    """Lowest point of every contact sphere in W [m], shape (spheres, 3)."""
    spheres = contact_spheres(subject.skeleton)
    return np.array(
        [
            (plant.GetBodyByName(s.body).EvalPoseInWorld(context) @ np.array(s.center)) - [0.0, 0.0, s.radius]
            for s in spheres
        ]
    )


def _did_you_mean(name: str, names: tuple[str, ...]) -> str:
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""
