"""Faces as solids for contact, and as pictures: what is below a face, with vertical walls, down to a common bottom.

Solids of neighboring faces touch along their whole walls, so that nothing catches between them.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import Box, Convex, HalfSpace, InMemoryMesh, Mesh, Shape
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array
from humanwalk.terrain.face import Color, Face
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

SUNK = 0.1
"""Distance of the bottom of all solids below the floor beside them [m]."""

PRISM = np.array(((4, 5, 6, 7), (3, 2, 1, 0), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)))
"""Faces of a prism, counterclockwise seen from outside: corners of the bottom 0 to 3, those of the top above them."""


def add_solids(plant: MultibodyPlant, faces: Sequence[Face], floor: float, properties: GroundProperties) -> None:
    """Register one solid for each face, whose friction is the face's.

    Args:
        plant: Not finalized.
        faces: All of one ground.
        floor: Height of the ground beside the faces [m].
        properties: For contact.
    """
    for i, face in enumerate(faces):
        X_WG, shape = _solid(face, floor - SUNK)
        plant.RegisterCollisionGeometry(plant.world_body(), X_WG, shape, f"ground_{i}", properties(face.friction))


def add_floor(plant: MultibodyPlant, height: float, friction: float, properties: GroundProperties) -> None:
    """Register the ground beside the faces: a half-space at a height [m]."""
    X_WG = RigidTransform(np.array((0.0, 0.0, height)))
    plant.RegisterCollisionGeometry(plant.world_body(), X_WG, HalfSpace(), "ground_beside", properties(friction))


def add_pictures(plant: MultibodyPlant, faces: Sequence[Face], floor: Face) -> None:
    """Register a mesh for each color.

    Args:
        plant: Not finalized.
        faces: In the order of columns, each along y.
        floor: The ground beside them.
    """
    begin = -BEHIND
    end = max(face.lower[0] for face in faces) + AHEAD
    prisms: dict[Color, list[Array]] = defaultdict(list)
    column, row, x = 0, 0, -np.inf
    for face in faces:
        column, row, x = (column, row + 1, x) if face.lower[0] == x else (column + 1, 0, face.lower[0])
        for i, tiles in enumerate(_clipped(face, begin, end).tiles(TILE)):
            for j, tile in enumerate(tiles):
                color = shown_color(face, SHADES[(column + row + i + j) % 2])
                prisms[color].append(_prism(tile, floor.intercept - SUNK))
    prisms[floor.color].append(_prism(_clipped(floor, begin, end), floor.intercept - SUNK))
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


def _solid(face: Face, bottom: float) -> tuple[RigidTransform, Shape]:
    """Pose and shape of what is below a face: a box below a level one, which Drake collides fastest."""
    if not face.is_level:
        return RigidTransform(), Convex(InMemoryMesh(mesh_file=MemoryFile(_obj([_prism(face, bottom)]), ".obj", "")))
    (x0, y0), (x1, y1), top = face.lower, face.upper, face.intercept
    center = np.array((x0 + x1, y0 + y1, bottom + top)) / 2.0
    return RigidTransform(center), Box(x1 - x0, y1 - y0, top - bottom)


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
