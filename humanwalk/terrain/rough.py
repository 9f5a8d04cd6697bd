"""A piece of a course with boxes of random heights."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from humanwalk.quantity import quantity
from humanwalk.terrain.face import Color, Face
from humanwalk.terrain.piece import Piece, intervals, require_few_faces


@dataclass(frozen=True)
class Rough(Piece):
    """Boxes side by side, of random heights."""

    color: ClassVar[Color] = (0.66, 0.62, 0.52)

    height: float = quantity(0.02, "m", 0.0, 0.4)
    """Heights are uniform from -height to height, drawn from the seed."""

    length: float = quantity(4.0, "m", 0.1, 1000.0)
    """Its length."""

    cell_size: float = quantity(0.4, "m", 0.05, 10.0)
    """Edges of a box on the level plane; adjusted so that whole boxes fit."""

    seed: int = quantity(0, "", 0, 2**32 - 1)
    """Of the heights."""

    def faces(self, width: float) -> list[Face]:
        xs = intervals(self.length, self.cell_size)
        ys = intervals(width, self.cell_size, begin=-0.5 * width)
        require_few_faces(len(xs) * len(ys), "cell_size", "choose a larger one")
        heights = np.random.default_rng(self.seed).uniform(-self.height, self.height, (len(xs), len(ys)))
        rows = zip(xs, heights.tolist(), strict=True)
        return [self.face(x, y, height) for x, row in rows for y, height in zip(ys, row, strict=True)]
