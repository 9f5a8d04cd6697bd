"""What the walker knows of the terrain: all of it, all with errors, or nothing but what its feet feel."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from humanwalk.numerics import Array
from humanwalk.quantity import quantity
from humanwalk.terrain.corrected import CorrectedGround
from humanwalk.terrain.plane import Plane
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.felt_ground import Feeling, FeltGround

FEELING = Feeling()
"""How the feet of the reference body feel the ground."""

WAVES = 12
"""Number of waves of a random error of the ground."""


class TerrainKnowledge(Protocol):
    """One way to know the terrain: a dataclass whose fields are the group of the scenario that its tag opens."""

    def ground(self, terrain: Ground, random: np.random.Generator, feeling: Feeling = FEELING) -> Ground:
        """Return what planner and whole-body program know of a terrain at the start."""


@dataclass(frozen=True)
class ExactKnowledge:
    """The terrain itself."""

    def ground(self, terrain: Ground, random: np.random.Generator, feeling: Feeling = FEELING) -> Ground:
        """See `TerrainKnowledge`."""
        return terrain


@dataclass(frozen=True)
class NoisyKnowledge:
    """The terrain with smooth random errors, as from a map or a camera; the feet correct it where they stand."""

    height: float = quantity(0.01, "m", 0.0, 0.2)
    """Standard deviation of the error of the height; with 0 the slope has no error either."""

    slope: float = quantity(0.02, "rad", 0.0, 0.3)
    """Standard deviation of the error of the slope along any direction."""

    def ground(self, terrain: Ground, random: np.random.Generator, feeling: Feeling = FEELING) -> Ground:
        """See `TerrainKnowledge`."""
        return FeltGround(NoisyGround(terrain, Waves.random(self.height, self.slope, random)), feeling=feeling)


@dataclass(frozen=True)
class BlindKnowledge:
    """Level ground, until the feet feel another one."""

    unevenness: float = quantity(0.05, "m", 0.0, 0.1)
    """Height by which the ground may stand out of what the feet feel; the swinging foot is lifted by so much more.
    Neighboring boxes of 2 cm differ by up to 4 cm (docs/howto/terrain.md)."""

    def ground(self, terrain: Ground, random: np.random.Generator, feeling: Feeling = FEELING) -> Ground:
        """See `TerrainKnowledge`."""
        return FeltGround(Plane(), unevenness=self.unevenness, feeling=feeling)


KNOWLEDGE: dict[str, type[TerrainKnowledge]] = {
    "exact": ExactKnowledge,
    "noisy": NoisyKnowledge,
    "blind": BlindKnowledge,
}
"""What a walker knows of the terrain, by its tag in a scenario."""


@dataclass(frozen=True)
class Waves:
    """A sum of plane waves of one length in random directions: a Gaussian height whose slope is Gaussian, too.

    Attributes:
        amplitude: Of each [m].
        numbers: Wave numbers along x and y [rad/m], shape (WAVES, 2).
        phases: [rad], shape (WAVES,).
    """

    amplitude: float
    numbers: Array
    phases: Array

    @staticmethod
    def random(height: float, slope: float, random: np.random.Generator) -> "Waves":
        """Waves with standard deviations of height [m] and of slope along any direction [rad]."""
        angles, phases = random.uniform(0.0, 2.0 * math.pi, (2, WAVES))
        # Half of the variance of the slope's size is along one direction.
        number = math.sqrt(2.0) * math.tan(slope) / max(height, 1e-9)
        numbers = number * np.stack((np.cos(angles), np.sin(angles)), axis=-1)
        return Waves(height * math.sqrt(2.0 / WAVES), numbers, phases)

    def height(self, xy: Array) -> Array:
        """Height at points (..., 2); shape (...)."""
        height: Array = self.amplitude * np.cos(xy @ self.numbers.T + self.phases).sum(axis=-1)
        return height

    def gradient(self, xy: Array) -> Array:
        """Slopes along x and y at points (..., 2); shape (..., 2)."""
        gradient: Array = -self.amplitude * np.sin(xy @ self.numbers.T + self.phases) @ self.numbers
        return gradient


@dataclass(frozen=True)
class NoisyGround(CorrectedGround):
    """A ground with errors."""

    base: Ground
    error: Waves

    def correction(self, xy: Array) -> tuple[Array, Array]:
        """See `CorrectedGround.correction`."""
        return self.error.height(xy), self.error.gradient(xy)
