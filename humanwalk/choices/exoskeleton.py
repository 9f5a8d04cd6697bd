"""Exoskeletons, which act with every controller."""

from pydrake.systems.framework import OutputPort

from humanwalk.choices.world import World
from humanwalk.systems.exoskeleton import Exoskeleton

SWITCH_PERIOD = 0.004
"""Time between two readings of the heel switches [s] (our choice)."""


def add_exoskeleton(world: World) -> OutputPort | None:
    """Add `exoskeleton` where the subject wears one, and connect it with the plant.

    Returns:
        The torques that the walker's model includes, (n) in actuator order [N m]; None without exoskeleton.
    """
    assistance = world.subject.assistance
    if not assistance:
        return None
    exoskeleton = world.add(
        "exoskeleton",
        Exoskeleton(world.plant, assistance, SWITCH_PERIOD),
        foot_forces=world.port("foot_contact", "foot_forces"),
    )
    world.generalized_forces.append(exoskeleton.GetOutputPort("generalized_force"))
    world.builder.ExportInput(exoskeleton.GetInputPort("command"), "exoskeleton_command")
    return exoskeleton.GetOutputPort("known_torque")
