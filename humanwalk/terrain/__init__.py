"""The ground as a surface over the level plane, and the solids that Drake collides and draws."""

from humanwalk.terrain.plane import Plane
from humanwalk.terrain.terrain import GroundProperties, Terrain

TERRAINS: dict[str, type[Terrain]] = {"plane": Plane}
"""The terrains that a scenario can name."""

__all__ = ["TERRAINS", "GroundProperties", "Plane", "Terrain"]
