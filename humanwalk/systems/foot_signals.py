"""The outputs and signals of every system that returns the ground reactions on feet."""

from collections.abc import Callable, Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body import Side
from humanwalk.contact.ground_force import FootForce
from humanwalk.systems.signal import Signal, xyz

COLUMNS = (*xyz("force_", "N"), *xyz("cop_", "m"), "free_moment_N_m", "loaded")
"""Columns of one foot: see `FootForce`."""


def foot_columns(sides: Sequence[Side]) -> tuple[str, ...]:
    """Columns of the ground reactions on feet."""
    return tuple(f"{side.lower()}_foot.{column}" for side in sides for column in COLUMNS)


def declare_foot_signals(
    system: LeafSystem,
    sides: Sequence[Side],
    calculate: Callable[[Context], Sequence[FootForce]],
) -> tuple[Signal, Signal]:
    """Declare the outputs `foot_forces` (8 per foot) and `friction_use` (1 per foot) of a system.

    Args:
        system: The system.
        sides: Sides of its feet.
        calculate: Ground reaction on each of these feet.

    Returns:
        The signals of both outputs.
    """

    def calc_forces(context: Context, output: BasicVector) -> None:
        output.SetFromVector(np.concatenate([foot.vector for foot in calculate(context)]))

    def calc_friction_use(context: Context, output: BasicVector) -> None:
        output.SetFromVector(np.array([foot.friction_use for foot in calculate(context)]))

    forces = system.DeclareVectorOutputPort("foot_forces", 8 * len(sides), calc_forces)
    friction_use = system.DeclareVectorOutputPort("friction_use", len(sides), calc_friction_use)
    return (
        Signal("foot_forces", forces, foot_columns(sides)),
        Signal("friction_use", friction_use, tuple(f"{side.lower()}_foot.friction_use" for side in sides)),
    )
