"""The two foot paths of the thesis' programs, for comparison and for plots.

Appendix A ("forward", the leg that swings first) and appendix B ("backward", the leg that stands first). Where the
printed tables differ from the programs, the programs are followed (erratum E14). The walk itself uses `foot_cycle`,
since the phases of these two drift apart (E26).

Lengths have any unit, the same in and out; the thesis uses centimeters (L 50, H 20, offset 5). Points are (x, y) as in
the thesis: x forward, y up, y = 0 the ground in walking.
"""

from typing import Literal

import numpy as np

from humanwalk.gait.splines import CubicHermite
from humanwalk.numerics import Array

LegPath = Literal["forward", "backward"]

CYCLES = 2
"""Of the figures and of the programs."""


def forward_control_points(step_length: float, step_height: float, offset: float) -> Array:
    """Control points of appendix A: 3 of the start and 13 per cycle, shape (3 + 13 CYCLES, 2)."""
    L, H, C = step_length, step_height, step_length / 18
    start = [(L / 2, -offset), (3 * L / 4, H), (L, 2 * L / 50)]
    x = L * np.array([5 / 6, 1 / 2, 1 / 6, 0, 1 / 10, 1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4, 5 / 6, 1])
    rise = [L / 50, L / 10 + L / 30, H / 3 + C, H / 2 + C, 2 * H / 3 + C]
    y = [0, 0, 0, *rise, H + C, *rise[:1:-1], 2 * L / 50]
    return np.vstack((start, np.tile(np.column_stack((x, y)), (CYCLES, 1))))


def backward_control_points(step_length: float, step_height: float, offset: float) -> Array:
    """Control points of appendix B: 2 of the start, 12 per cycle and the first of the next cycle.

    Shape (3 + 12 CYCLES, 2).
    """
    start = [(step_length / 2, -offset), (0, 0)]
    x = step_length * np.array([1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4, 5 / 6, 1, 5 / 6, 1 / 2, 1 / 6, 0])
    y = step_height * np.array([1 / 3, 1 / 2, 2 / 3, 1, 2 / 3, 1 / 2, 1 / 3, 0, 0, 0, 0, 0])
    cycle = np.column_stack((x, y))
    return np.vstack((start, np.tile(cycle, (CYCLES, 1)), cycle[:1]))


def thesis_path(path: LegPath, step_length: float, step_height: float, offset: float) -> CubicHermite:
    """Foot path of appendix A or B (Figures 4.2 to 4.7).

    The forward program never reaches its 29th point: the curve ends at the 28th, with the tangent of an end (E28).
    """
    if path == "forward":
        return CubicHermite(forward_control_points(step_length, step_height, offset)[:-1])
    return CubicHermite(backward_control_points(step_length, step_height, offset))
