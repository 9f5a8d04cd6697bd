"""The two foot paths of the thesis as its programs make them, for comparison and for plots.

Appendix A ("forward", the leg that swings first) and appendix B ("backward", the leg that stands
first). The code is followed where the tables differ from it (erratum E14). The walk itself uses
`foot_cycle`, since these two never keep step (E26).

Lengths: any unit, the same in and out; the thesis uses centimetres (L 50, H 20, offset 5). Points
are (x, y) as in the thesis: x forward, y up, y = 0 the ground while walking.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from humanwalk.gait.splines import CubicHermite
from humanwalk.numerics import Array

LegPath = Literal["forward", "backward"]


def forward_control_points(step_length: float, step_height: float, offset: float, cycles: int = 2) -> Array:
    """Control points of appendix A: 3 of the start and 13 a cycle, shape (3 + 13 cycles, 2)."""
    L, H = step_length, step_height
    C = L / 18
    start = [(L / 2, -offset), (3 * L / 4, H), (L, 2 * L / 50)]
    cycle = [
        (5 * L / 6, 0),
        (L / 2, 0),
        (L / 6, 0),
        (0, L / 50),
        (L / 10, L / 10 + L / 30),
        (L / 6, H / 3 + C),
        (L / 4, H / 2 + C),
        (L / 3, 2 * H / 3 + C),
        (L / 2, H + C),
        (2 * L / 3, 2 * H / 3 + C),
        (3 * L / 4, H / 2 + C),
        (5 * L / 6, H / 3 + C),
        (L, 2 * L / 50),
    ]
    return np.array(start + cycle * cycles, dtype=np.float64)


def backward_control_points(step_length: float, step_height: float, offset: float, cycles: int = 2) -> Array:
    """Control points of appendix B: 2 of the start, 12 a cycle and the first of the next one.

    Shape (3 + 12 cycles, 2).
    """
    L, H = step_length, step_height
    start = [(L / 2, -offset), (0, 0)]
    cycle = [
        (L / 6, H / 3),
        (L / 4, H / 2),
        (L / 3, 2 * H / 3),
        (L / 2, H),
        (2 * L / 3, 2 * H / 3),
        (3 * L / 4, H / 2),
        (5 * L / 6, H / 3),
        (L, 0),
        (5 * L / 6, 0),
        (L / 2, 0),
        (L / 6, 0),
        (0, 0),
    ]
    return np.array(start + cycle * cycles + cycle[:1], dtype=np.float64)


@dataclass(frozen=True)
class DenseCurve:
    """A foot path sampled segment by segment, both ends of every segment included.

    segment: index from 0, (n,); u: parameter within the segment, (n,); points: (n, 2);
    distance: sum of the chords from the start, (n,).
    """

    segment: npt.NDArray[np.int64]
    u: Array
    points: Array
    distance: Array


def thesis_curve(path: LegPath, step_length: float, step_height: float, offset: float, du: float = 0.01) -> DenseCurve:
    """Dense curve of appendix A or B with two cycles (Figures 4.2 to 4.7).

    The forward program never reaches its 29th point: the curve ends at the 28th, with the tangent
    of an end (E28). du divides 1. Repeated points at the joints are the programs' own.
    """
    if path == "forward":
        control_points = forward_control_points(step_length, step_height, offset)[:-1]
    else:
        control_points = backward_control_points(step_length, step_height, offset)
    spline = CubicHermite(control_points)
    steps = np.linspace(0.0, 1.0, round(1.0 / du) + 1)
    segment = np.repeat(np.arange(spline.segments), len(steps))
    u = np.tile(steps, spline.segments)
    points = spline.position(segment + u)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return DenseCurve(segment, u, points, np.concatenate([[0.0], np.cumsum(chords)]))
