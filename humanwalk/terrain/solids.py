"""Faces as boxes for contact, and as pictures: what is below a face, with vertical walls, down to a common bottom.

Boxes of neighboring faces meet in a line, so that nothing catches between them.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import Box, InMemoryMesh, Mesh
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array
from humanwalk.terrain.face import Color, Face
from humanwalk.terrain.piece import intervals
from humanwalk.terrain.terrain import GroundProperties

TILE = 1.0
"""Largest edge of a drawn tile [m]: two shades by turns show how far the walker has come."""

SHADES = (1.0, 0.92)
"""Factors on the color of the two kinds of tiles."""

ICE = np.array((0.62, 0.82, 0.95))
"""Color toward which slippery faces are drawn."""

GRIP, SLIP = 0.5, 0.1
"""Friction coefficients from which on a face is drawn as ice to some part, and completely."""

BEHIND, AHEAD = 6.0, 54.0
"""Extent of the drawn ground before the origin and behind the last piece [m]; the solids have no end."""

BESIDE = 10.0
"""Width of the drawn ground on each side of the strip [m]."""

SLAB = 0.05
"""Thickness of the boxes below tilted faces [m]: on a rise of 10 degrees the far end leans 9 mm ahead."""

SKEW = 0.01
"""Greatest distance by which a box below a tilted face protrudes at its sides [m]."""

MAX_SLABS = 100
"""Largest number of boxes below one face; a long and steep one may protrude farther."""

PRISM = np.array(((4, 5, 6, 7), (3, 2, 1, 0), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)))
"""Faces of a prism, counterclockwise seen from outside: corners of the bottom 0 to 3, those of the top above them."""


def add_solids(plant: MultibodyPlant, faces: Sequence[Face], bottom: float, properties: GroundProperties) -> None:
    """Register boxes below each face, whose friction is the face's.

    Args:
        plant: Not finalized.
        faces: All of one ground. Among many solids a half-space may crash Drake (drake#19263): none is used.
        bottom: Height of the lower faces of all solids [m].
        properties: For contact.
    """
    for i, face in enumerate(faces):
        for j, (X_WG, box) in enumerate(_boxes(face, bottom)):
            plant.RegisterCollisionGeometry(plant.world_body(), X_WG, box, f"ground_{i}_{j}", properties(face.friction))


def add_pictures(plant: MultibodyPlant, faces: Sequence[Face], beside: Sequence[Face], bottom: float) -> None:
    """Register a mesh for each color.

    Args:
        plant: Not finalized.
        faces: In the order of columns, each along y.
        beside: The ground beside them, drawn over `BESIDE`.
        bottom: Height of the lower faces of all solids [m].
    """
    begin, end = -BEHIND, max(face.lower[0] for face in faces) + AHEAD
    half = BESIDE + max(face.upper[1] for face in faces)
    prisms: dict[Color, list[Array]] = defaultdict(list)
    column, row, x = 0, 0, -np.inf
    for face in faces:
        column, row, x = (column, row + 1, x) if face.lower[0] == x else (column + 1, 0, face.lower[0])
        for i, tiles in enumerate(_clipped(face, begin, end).tiles(TILE)):
            for j, tile in enumerate(tiles):
                color = shown_color(face, SHADES[(column + row + i + j) % 2])
                prisms[color].append(_prism(tile, bottom))
    for face in beside:
        drawn = _clipped(face, begin, end)
        lower, upper = (drawn.lower[0], max(drawn.lower[1], -half)), (drawn.upper[0], min(drawn.upper[1], half))
        prisms[face.color].append(_prism(drawn._replace(lower=lower, upper=upper), bottom))
    for i, (color, solids) in enumerate(prisms.items()):
        mesh = Mesh(InMemoryMesh(mesh_file=MemoryFile(_obj(solids), ".obj", f"ground_{i}")))
        plant.RegisterVisualGeometry(plant.world_body(), RigidTransform(), mesh, f"ground_{i}", np.array((*color, 1.0)))


def shown_color(face: Face, shade: float = 1.0) -> Color:
    """Color of a face in pictures: its own, the more that of ice the more slippery it is."""
    ice = float(np.clip((GRIP - face.friction) / (GRIP - SLIP), 0.0, 1.0))
    r, g, b = (shade * ((1.0 - ice) * np.array(face.color) + ice * ICE)).tolist()
    return r, g, b


def _clipped(face: Face, begin: float, end: float) -> Face:
    return face._replace(
        lower=(max(face.lower[0], begin), face.lower[1]), upper=(min(face.upper[0], end), face.upper[1])
    )


def _boxes(face: Face, bottom: float) -> Iterator[tuple[RigidTransform, Box]]:
    """Poses and shapes of the boxes below a face: down to the bottom below a level one, else slabs along its plane.

    Drake measures how deep a sphere is in a box by a formula. For a convex prism it iterates, and may return the depth
    from a distant wall. The ends of every box are lines of constant x. Where a face goes up both ways, the sides of a
    box turn away from lines of constant y: the face is cut along x until its boxes protrude by no more than `SKEW`.
    """
    if face.is_level:
        (x0, y0), (x1, y1), top = face.lower, face.upper, face.intercept
        center = np.array((x0 + x1, y0 + y1, bottom + top)) / 2.0
        yield RigidTransform(center), Box(x1 - x0, y1 - y0, top - bottom)
        return
    normal = face.normal
    across = np.array((0.0, 1.0, face.gradient[1])) / np.hypot(1.0, face.gradient[1])
    along = np.cross(across, normal)
    turn = abs(along[1] / along[0])
    length = face.upper[0] - face.lower[0]
    slabs = min(1 + int(turn * length / SKEW), MAX_SLABS)
    for x0, x1 in intervals(length, length / slabs, face.lower[0]):
        y0, y1 = face.lower[1], face.upper[1]
        middle = np.array((0.5 * (x0 + x1), 0.5 * (y0 + y1)))
        center = np.array((*middle, float(face.height(middle)))) - 0.5 * SLAB * normal
        size_y = (y1 - y0 + turn * (x1 - x0)) / across[1]
        X_WG = RigidTransform(RotationMatrix(np.column_stack((along, across, normal))), center)
        yield X_WG, Box((x1 - x0) / along[0], size_y, SLAB)


def _prism(face: Face, bottom: float) -> Array:
    """Corners of what is below a face, shape (8, 3)."""
    top = face.corners
    return np.vstack((np.column_stack((top[:, :2], np.full(4, bottom))), top))


def _obj(prisms: Iterable[Array]) -> str:
    """A Wavefront OBJ file of prisms."""
    lines = []
    for k, corners in enumerate(prisms):
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in corners.tolist()]
        lines += ["f " + " ".join(str(corner) for corner in face) for face in (PRISM + 8 * k + 1).tolist()]
    return "\n".join(lines) + "\n"
