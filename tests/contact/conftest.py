"""Ground that is not a plane."""

from dataclasses import dataclass

import numpy as np
import pytest

from humanwalk.numerics import Array
from humanwalk.terrain import Terrain
from humanwalk.terrain.face import surface_axes


@dataclass(frozen=True)
class Waves(Terrain):
    """z = amplitude sin(x) cos(y)."""

    amplitude: float = 0.2
    mu: float = 0.7

    def height(self, xy: Array) -> Array:
        x, y = np.moveaxis(xy, -1, 0)
        return self.amplitude * np.sin(x) * np.cos(y)

    def axes(self, xy: Array) -> Array:
        x, y = np.moveaxis(xy, -1, 0)
        slope_x, slope_y = self.amplitude * np.cos(x) * np.cos(y), -self.amplitude * np.sin(x) * np.sin(y)
        return surface_axes(np.stack((-slope_x, -slope_y, np.ones_like(x)), axis=-1))

    def friction(self, xy: Array) -> Array:
        return np.full(xy.shape[:-1], self.mu)


@pytest.fixture(scope="session")
def waves() -> type[Waves]:
    return Waves
