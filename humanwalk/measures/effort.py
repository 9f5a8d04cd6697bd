"""Torque, work and cost of transport of the joints."""

from collections.abc import Sequence
from typing import TypedDict

import numpy as np
import pyarrow as pa

from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import GRAVITY


class JointWork(TypedDict):
    """Work of a joint per stride [J]: delivered, and absorbed (negative)."""

    positive: float
    negative: float


def joint_names(signals: pa.Table) -> list[str]:
    """The actuated joints of a record, in actuator order."""
    ending = ".torque_N_m"
    return [name.removesuffix(ending) for name in signals.column_names if name.endswith(ending)]


def joint_power(signals: pa.Table) -> Array:
    """Torque times rate of every joint [W], shape (rows, joints), in the order of `joint_names`."""
    names = joint_names(signals)
    torque = matrix(signals, [f"{name}.torque_N_m" for name in names])
    return torque * matrix(signals, [f"{name}.velocity_rad_s" for name in names])


def cost_of_transport(signals: pa.Table, rows: Mask, mass: float, distance: float) -> float | None:
    """Mechanical cost of transport: time integral of sum |torque x rate| over m g d, without recovery of negative work.

    Args:
        signals: the record.
        rows: rows of the record that count.
        mass: of the body [kg].
        distance: that the walk covers in these rows [m]; None is returned if it is not positive.
    """
    if rows.sum() < 2 or distance <= 0.0:
        return None
    time = signals[TIME].to_numpy()[rows]
    power = np.abs(joint_power(signals)[rows]).sum(axis=1)
    return float(np.trapezoid(power, time) / (mass * GRAVITY * distance))


def joint_work(signals: pa.Table, strides: Sequence[tuple[int, int]]) -> dict[str, JointWork] | None:
    """Work of every joint per stride [J], delivered (positive) and absorbed (negative): integrals of torque x rate.

    Args:
        signals: the record.
        strides: first and last row of each stride.

    Returns:
        The work by joint; None if there are no strides.
    """
    if not strides:
        return None
    time, power = signals[TIME].to_numpy(), joint_power(signals)
    positive, negative = (
        np.mean([np.trapezoid(part[a : b + 1], time[a : b + 1], axis=0) for a, b in strides], axis=0)
        for part in (np.maximum(power, 0.0), np.minimum(power, 0.0))
    )
    return {
        name: {"positive": float(delivered), "negative": float(absorbed)}
        for name, delivered, absorbed in zip(joint_names(signals), positive, negative, strict=True)
    }
