"""The ground as a surface, and its geometry in Drake."""

from humanwalk.terrain.course import PIECES, Course
from humanwalk.terrain.face import Face
from humanwalk.terrain.piece import Piece
from humanwalk.terrain.plane import Plane
from humanwalk.terrain.terrain import Ground, GroundProperties, Surface, Terrain, highest_along

TERRAINS: dict[str, type[Terrain]] = {"plane": Plane, "course": Course}
"""Terrains by their tag in a scenario."""

__all__ = [
    "PIECES",
    "TERRAINS",
    "Course",
    "Face",
    "Ground",
    "GroundProperties",
    "Piece",
    "Plane",
    "Surface",
    "Terrain",
    "highest_along",
]
