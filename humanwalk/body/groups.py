"""Joints and bodies of the human that belong together."""

from humanwalk.body.anatomy import human
from humanwalk.body.contact import SOLE_PARTS
from humanwalk.body.skeleton import SIDES, Side

FOOT_BODIES: dict[Side, tuple[str, ...]] = {
    side: tuple(f"{side}Leg_{part.body}" for part in SOLE_PARTS) for side in SIDES
}
"""The bodies of each foot that touch the ground."""


def _spine_joints(axis: tuple[float, float, float]) -> tuple[str, ...]:
    return tuple(
        joint.name for joint in human().joints if joint.child.startswith(("Lumbar", "Thoracic")) and joint.axis == axis
    )


SPINE_PITCH_JOINTS = _spine_joints((0.0, 1.0, 0.0))
"""Lumbar and thoracic joints that flex; positive forward."""
SPINE_ROLL_JOINTS = _spine_joints((1.0, 0.0, 0.0))
"""Lumbar and thoracic joints that bend sideways; positive to the right."""
SPINE_YAW_JOINTS = _spine_joints((0.0, 0.0, 1.0))
"""Lumbar and thoracic joints that turn; positive to the left."""
