"""Signals: what a system declares of itself to be recorded."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from pydrake.systems.framework import OutputPort, System


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
