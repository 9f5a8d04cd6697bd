"""Faces that tile a strip along x, and level ground beside it: one lookup returns the face of every point.

Faces with the same extent along x form a column; in each column faces follow each other along y. A point belongs to the
last column that begins at or before its x, and in it to the last face that begins at or before its y.
"""

from collections.abc import Sequence

import numpy as np

from humanwalk.numerics import Array, Indices
from humanwalk.terrain.face import Face
from humanwalk.terrain.terrain import Surface

WALL_NORMALS = np.array(((-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)))
"""Outward normals of the walls below the edges of a face, on the level plane: back, front, right, left."""

R_WALLS = np.array([((-y, x, 0.0), (0.0, 0.0, 1.0), (x, y, 0.0)) for x, y in WALL_NORMALS.tolist()])
"""Axes of these walls: level, upward, outward normal; shape (4, 3, 3)."""

ACROSS = 1e-6
"""Distance from a wall at which the height beside it is taken [m]."""


class FaceMap:
    """Lookup of faces.

    Attributes:
        faces: The strip's, in the order of columns, each along y.
        beside: Level ground to the right and left of it.
    """

    def __init__(self, faces: Sequence[Face], beside: tuple[Face, Face]) -> None:
        """Initialize the map.

        Args:
            faces: Tile the strip without gap or overlap.
            beside: Ground to the right and left of the strip, along all of it.
        """
        self.faces, self.beside = tuple(sorted(faces, key=lambda face: face.lower)), beside
        begins = sorted({face.lower[0] for face in self.faces})
        ends = {face.lower[0]: face.upper[0] for face in self.faces}
        sides = [
            side._replace(lower=(x, side.lower[1]), upper=(ends[x], side.upper[1])) for x in begins for side in beside
        ]
        cells = sorted([*self.faces, *sides], key=lambda face: face.lower)
        self._whole = _joined(cells)
        # One sorted list finds column and face: the key of a point is its y plus the span of a column times its number.
        self._edge = beside[1].lower[1] + 1.0
        self._span = 2.0 * self._edge + 1.0
        self._begins = np.array(begins)
        self._lower, self._upper = np.array([cell.lower for cell in cells]), np.array([cell.upper for cell in cells])
        self._keys = self._key(self._column(self._lower[:, 0]), self._lower[:, 1])
        self._plane = np.array([(cell.intercept, *cell.gradient) for cell in cells])
        self._friction = np.array([cell.friction for cell in cells])
        self._R_SW = np.array([cell.R_SW for cell in cells])

    def _column(self, x: Array) -> Indices:
        column: Indices = np.searchsorted(self._begins, x, side="right") - 1
        return np.maximum(column, 0)

    def _key(self, column: Indices, y: Array) -> Array:
        key: Array = np.minimum(np.maximum(y, -self._edge), self._edge) + self._span * column
        return key

    def _index(self, xy: Array) -> Indices:
        key = self._key(self._column(xy[..., 0]), xy[..., 1])
        index: Indices = np.searchsorted(self._keys, key, side="right") - 1
        return index

    def height(self, xy: Array) -> Array:
        """See `Terrain.height`."""
        plane = self._plane[self._index(xy)]
        height: Array = plane[..., 0] + plane[..., 1] * xy[..., 0] + plane[..., 2] * xy[..., 1]
        return height

    def axes(self, xy: Array) -> Array:
        """See `Terrain.axes`."""
        axes: Array = self._R_SW[self._index(xy)]
        return axes

    def friction(self, xy: Array) -> Array:
        """See `Terrain.friction`."""
        friction: Array = self._friction[self._index(xy)]
        return friction

    def face_at(self, xy: Array) -> Face:
        """The face at a point xy [m], shape (2,), together with all faces before and behind it in the same plane."""
        return self._whole[int(self._index(xy))]

    def faces_near(self, xy: Array, distance: float) -> tuple[Face, ...]:
        """See `Ground.faces_near`; each face as `face_at` returns it, once."""
        is_near = (self._lower <= xy + distance) & (self._upper >= xy - distance)
        return tuple(dict.fromkeys(self._whole[i] for i in np.flatnonzero(is_near.all(axis=1))))

    def nearest(self, p_W: Array) -> Surface:
        """See `Terrain.nearest`; a point in the ground may be nearer to a wall, such as a riser, than to the top."""
        xy, z = p_W[:, :2], p_W[:, 2]
        index = self._index(xy)
        R_SW, friction = self._R_SW[index], self._friction[index]
        distance = (z - self.height(xy)) * R_SW[:, 2, 2]
        (inside,) = np.nonzero(distance < 0.0)
        if inside.size:
            at, face = xy[inside], index[inside]
            walls = np.concatenate((self._lower[face] - at, at - self._upper[face]), axis=1)[:, [0, 2, 1, 3]]
            beside = at[:, None] + (ACROSS - walls)[:, :, None] * WALL_NORMALS
            # The part of a wall below the ground beside it is buried.
            walls = np.where(self.height(beside) < z[inside, None], walls, -np.inf)
            side = walls.argmax(axis=1)
            to_wall = walls[np.arange(inside.size), side]
            nearer = to_wall > distance[inside]
            distance[inside[nearer]] = to_wall[nearer]
            R_SW[inside[nearer]] = R_WALLS[side[nearer]]
        return Surface(distance, R_SW, friction)


def _joined(cells: Sequence[Face]) -> list[Face]:
    """Each cell with the extent along x of all cells that continue its plane."""
    groups: list[list[int]] = []
    of_column: dict[tuple[float, float], list[int]] = {}
    open_groups, begin = of_column, -np.inf
    for i, cell in enumerate(cells):
        if cell.lower[0] != begin:
            open_groups, of_column, begin = of_column, {}, cell.lower[0]
        extent = (cell.lower[1], cell.upper[1])
        group = open_groups.get(extent)
        if group is None or not _coplanar(cells[group[-1]], cell):
            group = []
            groups.append(group)
        group.append(i)
        of_column[extent] = group
    joined = list(cells)
    for group in groups:
        begin, end = cells[group[0]].lower[0], cells[group[-1]].upper[0]
        for i in group:
            cell = cells[i]
            joined[i] = cell._replace(lower=(begin, cell.lower[1]), upper=(end, cell.upper[1]))
    return joined


def _coplanar(a: Face, b: Face) -> bool:
    return bool(
        np.allclose(a.gradient, b.gradient, atol=1e-12) and np.allclose(a.corners[1, 2], b.corners[0, 2], atol=1e-9)
    )
