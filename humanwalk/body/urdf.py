"""URDF model of a skeleton: the same bodies, joints, actuators and contact shapes as in the SDF model.

Drake reads all of it. Ellipsoids, capsules and contact properties are Drake's extensions, in its namespace; other
readers have to skip them.
"""

import xml.etree.ElementTree as ET

from humanwalk.body.contact import ContactSphere, contact_spheres, sole_properties
from humanwalk.body.flesh import Flesh
from humanwalk.body.model_text import number, numbers
from humanwalk.body.sdf import HEADER, LOOKS, MODEL_NAME, Look
from humanwalk.body.shapes import Vector3
from humanwalk.body.skeleton import Joint, Segment, Skeleton, Weld
from humanwalk.body.visual import Visual
from humanwalk.quantity import ParameterError
from humanwalk.sides import SIDES

DRAKE_NAMESPACE = "http://drake.mit.edu"

MAX_VELOCITY = 100.0
"""Velocity limit of the joints, which URDF requires [rad/s]: beyond every motion."""


def to_urdf(skeleton: Skeleton, look: Look = "person") -> str:
    """Return the URDF model file of a skeleton.

    Frames are those of the SDF model: at the inboard joint, parallel to the world in neutral standing. The links
    `RightLeg_Sole` and `LeftLeg_Sole` without mass are on the sole planes below the ankles. The pelvis floats; URDF has
    no place for its initial height.

    Args:
        skeleton: The body.
        look: A clothed person, or rods between joints.

    Returns:
        XML, ending in a newline.

    Raises:
        ParameterError: A joint has a spring, for which URDF has no place.
    """
    for joint in skeleton.joints:
        if joint.stiffness > 0.0:
            raise ParameterError(
                f"urdf: {joint.name} has a passive spring, for which URDF has no element; allowed: bodies without "
                "springs; write .sdf, .xml or .osim"
            )
    robot = ET.Element("robot", {"name": MODEL_NAME, "xmlns:drake": DRAKE_NAMESPACE})
    robot.append(ET.Comment(HEADER))
    spheres, looks = contact_spheres(skeleton), LOOKS[look](skeleton)
    for segment, inboard in skeleton.tree():
        link = ET.SubElement(robot, "link", {"name": segment.name})
        link.append(_inertial(segment))
        link.extend(_visual(visual) for visual in looks if visual.body == segment.name)
        link.extend(_collision(sphere, skeleton.flesh) for sphere in spheres if sphere.body == segment.name)
        if isinstance(inboard, Joint):
            robot.append(_revolute(inboard))
            robot.append(_transmission(inboard))
        elif isinstance(inboard, Weld):
            robot.append(_joint(inboard.name, "fixed", inboard.parent, inboard.child, inboard.origin))
    for side in SIDES:
        sole, ankle = f"{side}Leg_Sole", f"{side}Leg_Ankle"
        ET.SubElement(robot, "link", {"name": sole})
        robot.append(_joint(f"{sole}_Weld", "fixed", ankle, sole, (0.0, 0.0, -skeleton.ankle_height(side))))
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"


def _inertial(segment: Segment) -> ET.Element:
    inertial = ET.Element("inertial")
    inertial.append(_origin(segment.com))
    ET.SubElement(inertial, "mass", {"value": number(segment.mass)})
    moments = dict(zip(("ixx", "iyy", "izz"), map(number, segment.inertia), strict=True))
    ET.SubElement(inertial, "inertia", moments | dict.fromkeys(("ixy", "ixz", "iyz"), "0"))
    return inertial


def _joint(name: str, kind: str, parent: str, child: str, origin: Vector3) -> ET.Element:
    joint = ET.Element("joint", {"name": name, "type": kind})
    ET.SubElement(joint, "parent", {"link": parent})
    ET.SubElement(joint, "child", {"link": child})
    joint.append(_origin(origin))
    return joint


def _revolute(joint: Joint) -> ET.Element:
    element = _joint(joint.name, "revolute", joint.parent, joint.child, joint.origin)
    ET.SubElement(element, "axis", {"xyz": numbers(joint.axis)})
    lower, upper = map(number, joint.range_rad)
    limit = {"lower": lower, "upper": upper, "effort": number(joint.effort_limit_N_m), "velocity": number(MAX_VELOCITY)}
    ET.SubElement(element, "limit", limit)
    ET.SubElement(element, "dynamics", {"damping": number(joint.damping)})
    return element


def _transmission(joint: Joint) -> ET.Element:
    transmission = ET.Element("transmission", {"name": f"{joint.name}_Transmission"})
    ET.SubElement(transmission, "type").text = "transmission_interface/SimpleTransmission"
    moved = ET.SubElement(transmission, "joint", {"name": joint.name})
    ET.SubElement(moved, "hardwareInterface").text = "hardware_interface/EffortJointInterface"
    actuator = ET.SubElement(transmission, "actuator", {"name": joint.name})
    ET.SubElement(actuator, "mechanicalReduction").text = "1"
    ET.SubElement(actuator, "drake:rotor_inertia", {"value": number(joint.rotor_inertia)})
    ET.SubElement(actuator, "drake:gear_ratio", {"value": "1"})
    return transmission


def _visual(look: Visual) -> ET.Element:
    visual = ET.Element("visual", {"name": look.name})
    visual.append(_origin(look.center, look.rpy))
    geometry = ET.SubElement(visual, "geometry")
    if look.primitive == "ellipsoid":
        ET.SubElement(geometry, "drake:ellipsoid", dict(zip("abc", map(number, look.size), strict=True)))
    elif look.primitive == "box":
        ET.SubElement(geometry, "box", {"size": numbers(look.size)})
    else:
        name = "cylinder" if look.primitive == "cylinder" else "drake:capsule"
        ET.SubElement(geometry, name, dict(zip(("radius", "length"), map(number, look.size), strict=True)))
    material = ET.SubElement(visual, "material", {"name": f"{look.name}_Material"})
    ET.SubElement(material, "color", {"rgba": numbers((*look.color, 1.0))})
    return visual


def _collision(sphere: ContactSphere, flesh: Flesh) -> ET.Element:
    collision = ET.Element("collision", {"name": sphere.name})
    collision.append(_origin(sphere.center))
    ET.SubElement(ET.SubElement(collision, "geometry"), "sphere", {"radius": number(sphere.radius)})
    contact = ET.SubElement(collision, "drake:proximity_properties")
    for tag, text in sole_properties(sphere, flesh).items():
        ET.SubElement(contact, tag, {"value": text})
    return collision


def _origin(xyz: Vector3, rpy: Vector3 = (0.0, 0.0, 0.0)) -> ET.Element:
    return ET.Element("origin", {"xyz": numbers(xyz), "rpy": numbers(rpy)})
