"""The ground as a surface, and its geometry in Drake."""

from humanwalk.terrain.plane import Plane
from humanwalk.terrain.terrain import GroundProperties, Terrain

TERRAINS: dict[str, type[Terrain]] = {"plane": Plane}
"""Terrains by their tag in a scenario."""

__all__ = ["TERRAINS", "GroundProperties", "Plane", "Terrain"]
