"""MJCF model of a skeleton, for MuJoCo: the same bodies, joints and contact spheres as in the SDF model.

Mass matrix and bias forces are equal to rounding. Contact is not: MuJoCo's soft contact has the relaxation time of the
SDF model. Torque limits are the control ranges of the motors.
"""

import xml.etree.ElementTree as ET

from humanwalk.body.contact import FRICTION, contact_spheres
from humanwalk.body.model_text import number, numbers
from humanwalk.body.sdf import HEADER, LOOKS, MODEL_NAME, Look
from humanwalk.body.skeleton import Joint, Segment, Skeleton
from humanwalk.body.visual import Visual
from humanwalk.quantity import GRAVITY
from humanwalk.sides import SIDES


def to_mjcf(skeleton: Skeleton, look: Look = "person") -> str:
    """Return the MJCF model file of a skeleton on level ground.

    Body frames are those of the SDF model: at the inboard joint, parallel to the world in neutral standing. The sites
    `RightLeg_Sole` and `LeftLeg_Sole` are on the sole planes below the ankles. Motors have the order and the names of
    the joints. Soles collide with the ground only.

    Args:
        skeleton: The body.
        look: A clothed person, or rods between joints.

    Returns:
        XML, ending in a newline.
    """
    mujoco = ET.Element("mujoco", {"model": MODEL_NAME})
    mujoco.append(ET.Comment(HEADER))
    # Capital letters stand for rotations about fixed axes, as in SDF.
    ET.SubElement(mujoco, "compiler", {"angle": "radian", "eulerseq": "XYZ", "inertiafromgeom": "false"})
    ET.SubElement(
        mujoco,
        "option",
        {"timestep": "0.001", "integrator": "implicitfast", "cone": "elliptic", "gravity": numbers((0, 0, -GRAVITY))},
    )
    default = ET.SubElement(mujoco, "default")
    reference = numbers((skeleton.flesh.sole_relaxation_time, 1))
    friction = {"friction": numbers((FRICTION, 0, 0)), "condim": "3", "solref": reference}
    ET.SubElement(default, "geom", friction)
    world = ET.SubElement(mujoco, "worldbody")
    ground = {"name": "ground", "type": "plane", "size": "0 0 1", "contype": "1", "conaffinity": "0"}
    ET.SubElement(world, "geom", ground)
    bodies: dict[str, ET.Element] = {}
    spheres, looks = contact_spheres(skeleton), LOOKS[look](skeleton)
    for segment, inboard in skeleton.tree():
        outer = world if inboard is None else bodies[inboard.parent]
        origin = (0, 0, skeleton.root_height) if inboard is None else inboard.origin
        bodies[segment.name] = body = ET.SubElement(outer, "body", {"name": segment.name, "pos": numbers(origin)})
        if inboard is None:
            ET.SubElement(body, "freejoint", {"name": segment.name})
        elif isinstance(inboard, Joint):
            body.append(_hinge(inboard))
        body.append(_inertial(segment))
        body.extend(_visual(visual) for visual in looks if visual.body == segment.name)
        for sphere in spheres:
            if sphere.body == segment.name:
                shape = {"name": sphere.name, "pos": numbers(sphere.center), "size": number(sphere.radius)}
                ET.SubElement(body, "geom", shape | {"contype": "0", "conaffinity": "1"})
    for side in SIDES:
        sole = {"name": f"{side}Leg_Sole", "pos": numbers((0, 0, -skeleton.ankle_height(side)))}
        ET.SubElement(bodies[f"{side}Leg_Ankle"], "site", sole)
    actuator = ET.SubElement(mujoco, "actuator")
    for joint in skeleton.joints:
        limit = number(joint.effort_limit_N_m)
        torque = {"ctrllimited": "true", "ctrlrange": f"-{limit} {limit}"}
        ET.SubElement(actuator, "motor", {"name": joint.name, "joint": joint.name} | torque)
    ET.indent(mujoco)
    return ET.tostring(mujoco, encoding="unicode") + "\n"


def _hinge(joint: Joint) -> ET.Element:
    limits = {"limited": "true", "range": numbers(joint.range_rad)}
    dynamics = {"damping": number(joint.damping), "armature": number(joint.rotor_inertia)}
    if joint.stiffness > 0.0:
        dynamics |= {"stiffness": number(joint.stiffness), "springref": number(joint.rest_angle)}
    return ET.Element("joint", {"name": joint.name, "axis": numbers(joint.axis)} | limits | dynamics)


def _inertial(segment: Segment) -> ET.Element:
    mass = {"pos": numbers(segment.com), "mass": number(segment.mass), "diaginertia": numbers(segment.inertia)}
    return ET.Element("inertial", mass)


def _visual(look: Visual) -> ET.Element:
    if look.primitive == "ellipsoid":
        size = look.size
    elif look.primitive == "box":
        size = tuple(0.5 * edge for edge in look.size)
    else:
        size = (look.size[0], 0.5 * look.size[1])
    shape = {"name": f"{look.body}_{look.name}", "type": look.primitive, "size": numbers(size)}
    pose = {"pos": numbers(look.center), "euler": numbers(look.rpy)}
    drawn_only = {"contype": "0", "conaffinity": "0", "group": "1"}
    return ET.Element("geom", shape | pose | {"rgba": numbers((*look.color, 1))} | drawn_only)
