"""OpenSim model of a skeleton: bodies, joints, and the markers of motion capture.

Coordinates have the names and signs of exported motions (`humanwalk.body.opensim_names`), so that OpenSim replays them.
Axes are OpenSim's: x forward, y up, z right. Loads and devices are bodies, passive springs of joints are forces.
Contact, damping, actuators and the inertia of their rotors are left out: OpenSim adds forces of its own.
"""

import xml.etree.ElementTree as ET

import numpy as np

from humanwalk.body.markers import markers
from humanwalk.body.model_text import number, numbers
from humanwalk.body.opensim_names import COORDINATES, PELVIS_ROTATIONS, PELVIS_TRANSLATIONS, R_OW
from humanwalk.body.sdf import HEADER, MODEL_NAME
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import Joint, Segment, Skeleton, Weld
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY

VERSION = "40000"

MAX_DISTANCE = 1000.0
"""Range of the pelvis' translations [m]."""


def to_osim(skeleton: Skeleton) -> str:
    """Return the OpenSim 4 model file of a skeleton; XML, ending in a newline."""
    document = ET.Element("OpenSimDocument", {"Version": VERSION})
    model = ET.SubElement(document, "Model", {"name": MODEL_NAME})
    model.append(ET.Comment(HEADER))
    ET.SubElement(model, "gravity").text = numbers((0.0, -GRAVITY, 0.0))
    bodies, joints = _set(model, "BodySet"), _set(model, "JointSet")
    for segment, inboard in skeleton.tree():
        bodies.append(_body(segment))
        if isinstance(inboard, Joint):
            joints.append(_revolute(inboard))
        elif isinstance(inboard, Weld):
            joints.append(
                _joint("WeldJoint", inboard.name, f"/bodyset/{inboard.parent}", inboard.child, inboard.origin)
            )
        else:
            joints.append(_floating(segment.name, skeleton.root_height))
    springs = [joint for joint in skeleton.joints if joint.stiffness > 0.0]
    if springs:
        forces = _set(model, "ForceSet")
        forces.extend(map(_spring, springs))
    found = _set(model, "MarkerSet")
    for marker in markers(skeleton):
        element = ET.SubElement(found, "Marker", {"name": marker.name})
        ET.SubElement(element, "socket_parent_frame").text = f"/bodyset/{marker.body}"
        ET.SubElement(element, "location").text = _vector(marker.position)
    ET.indent(document)
    return '<?xml version="1.0" encoding="UTF-8" ?>\n' + ET.tostring(document, encoding="unicode") + "\n"


def _set(model: ET.Element, kind: str) -> ET.Element:
    return ET.SubElement(ET.SubElement(model, kind, {"name": kind.lower()}), "objects")


def _vector(vector: Vector3 | Array) -> str:
    return numbers(R_OW @ np.asarray(vector))


def _body(segment: Segment) -> ET.Element:
    body = ET.Element("Body", {"name": segment.name})
    ET.SubElement(body, "mass").text = number(segment.mass)
    ET.SubElement(body, "mass_center").text = _vector(segment.com)
    # Principal moments, permuted with the axes; the products are zero.
    ET.SubElement(body, "inertia").text = numbers((*(np.abs(R_OW) @ segment.inertia), 0.0, 0.0, 0.0))
    return body


def _joint(kind: str, name: str, parent: str, child: str, origin: Vector3) -> ET.Element:
    """A joint whose frame on the parent is at `origin`, and on the child at its origin."""
    joint = ET.Element(kind, {"name": name})
    ET.SubElement(joint, "socket_parent_frame").text = "parent_offset"
    ET.SubElement(joint, "socket_child_frame").text = f"/bodyset/{child}"
    frames = ET.SubElement(joint, "frames")
    offset = ET.SubElement(frames, "PhysicalOffsetFrame", {"name": "parent_offset"})
    ET.SubElement(offset, "socket_parent").text = parent
    ET.SubElement(offset, "translation").text = _vector(origin)
    ET.SubElement(offset, "orientation").text = numbers((0.0, 0.0, 0.0))
    return joint


def _revolute(joint: Joint) -> ET.Element:
    coordinate, factor = COORDINATES.get(joint.name, (joint.name, 1.0))
    element = _joint("CustomJoint", joint.name, f"/bodyset/{joint.parent}", joint.child, joint.origin)
    limits = sorted(factor * limit for limit in joint.range_rad)
    coordinates = ET.SubElement(element, "coordinates")
    coordinates.append(_coordinate(coordinate, 0.0, (limits[0], limits[1])))
    axis = factor * (R_OW @ np.asarray(joint.axis))
    # The other two rotations are zero; they only have to be independent of the first.
    others = np.linalg.svd(axis[None, :])[2][1:]
    moves = [(axis, coordinate), (others[0], ""), (others[1], ""), *((unit, "") for unit in np.eye(3))]
    element.append(_transform(moves))
    return element


def _floating(body: str, height: float) -> ET.Element:
    element = _joint("CustomJoint", f"ground_{body}", "/ground", body, (0.0, 0.0, 0.0))
    coordinates = ET.SubElement(element, "coordinates")
    for name in PELVIS_ROTATIONS:
        coordinates.append(_coordinate(name, 0.0, (-np.pi, np.pi)))
    for name, value in zip(PELVIS_TRANSLATIONS, R_OW @ np.array((0.0, 0.0, height)), strict=True):
        coordinates.append(_coordinate(name, value, (-MAX_DISTANCE, MAX_DISTANCE)))
    x, y, z = np.eye(3)
    element.append(_transform(list(zip((z, x, y, x, y, z), (*PELVIS_ROTATIONS, *PELVIS_TRANSLATIONS), strict=True))))
    return element


def _spring(joint: Joint) -> ET.Element:
    """The passive spring of a joint."""
    coordinate, factor = COORDINATES.get(joint.name, (joint.name, 1.0))
    spring = ET.Element("SpringGeneralizedForce", {"name": f"{joint.name}_Spring"})
    ET.SubElement(spring, "coordinate").text = coordinate
    ET.SubElement(spring, "stiffness").text = number(joint.stiffness)
    ET.SubElement(spring, "rest_length").text = number(factor * joint.rest_angle)
    ET.SubElement(spring, "viscosity").text = number(0.0)
    return spring


def _coordinate(name: str, value: float, limits: tuple[float, float]) -> ET.Element:
    coordinate = ET.Element("Coordinate", {"name": name})
    ET.SubElement(coordinate, "default_value").text = number(value)
    ET.SubElement(coordinate, "range").text = numbers(limits)
    return coordinate


def _transform(moves: list[tuple[Array, str]]) -> ET.Element:
    """Three rotations, then three translations, each about or along an axis by a coordinate, or by nothing."""
    transform = ET.Element("SpatialTransform")
    names = [f"{kind}{i}" for kind in ("rotation", "translation") for i in (1, 2, 3)]
    for name, (axis, coordinate) in zip(names, moves, strict=True):
        element = ET.SubElement(transform, "TransformAxis", {"name": name})
        ET.SubElement(element, "coordinates").text = coordinate
        ET.SubElement(element, "axis").text = numbers(axis)
        if coordinate:
            function = ET.SubElement(element, "LinearFunction", {"name": "function"})
            ET.SubElement(function, "coefficients").text = "1 0"
        else:
            function = ET.SubElement(element, "Constant", {"name": "function"})
            ET.SubElement(function, "value").text = "0"
    return transform
