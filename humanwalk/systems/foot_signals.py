"""The outputs and signals of every system that returns the ground reactions on feet."""

from collections.abc import Callable, Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body import Side
from humanwalk.contact.ground_force import FootForce
from humanwalk.systems.signal import Signal, xyz

COLUMNS = (*xyz("force_", "N"), *xyz("cop_", "m"), "free_moment_N_m", "loaded")
"""Columns of one foot: see `FootForce`."""


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
    names = [f"{side.lower()}_foot" for side in sides]
    return (
        Signal("foot_forces", forces, tuple(f"{name}.{column}" for name in names for column in COLUMNS)),
        Signal("friction_use", friction_use, tuple(f"{name}.friction_use" for name in names)),
    )
