"""Signals: what a system declares of itself to be recorded."""

from collections.abc import Iterable
from typing import NamedTuple

from pydrake.systems.framework import OutputPort, System

from humanwalk.body.joint_map import JointMap


class Signal(NamedTuple):
    """A vector output port that runs record.

    Attributes:
        name: under which the diagram exports the port.
        port: the output port.
        columns: one name per element, `thing.quantity_unit`: `RightLegTibiaMotion.angle_rad`.
    """

    name: str
    port: OutputPort
    columns: tuple[str, ...]


def signals_of(systems: Iterable[System]) -> list[Signal]:
    """The signals that systems declare in an attribute `signals`, in the order of the systems."""
    return [signal for system in systems for signal in getattr(system, "signals", ())]


def state_columns(joints: JointMap) -> tuple[str, ...]:
    """Columns of a plant's state [q; v] with the pelvis as floating base."""
    n = joints.num_positions
    columns = [""] * (2 * n - 1)
    pelvis = floating_base("pelvis.")
    columns[:7], columns[n : n + 6] = pelvis[:7], pelvis[7:]
    for name, q, v in zip(joints.names, joints.q, joints.v, strict=True):
        columns[q], columns[n + v] = f"{name}.angle_rad", f"{name}.velocity_rad_s"
    return tuple(columns)


def xyz(prefix: str, unit: str) -> tuple[str, ...]:
    """Columns of a vector in W."""
    return tuple(f"{prefix}{axis}_{unit}" for axis in "xyz")


def floating_base(prefix: str) -> tuple[str, ...]:
    """Columns of a floating base's state as Drake orders it: quaternion, position, angular velocity, velocity."""
    return (
        *(f"{prefix}quaternion_{axis}" for axis in "wxyz"),
        *xyz(prefix, "m"),
        *xyz(f"{prefix}angular_velocity_", "rad_s"),
        *xyz(f"{prefix}velocity_", "m_s"),
    )
