"""A course: pieces one after the other along x, on a strip of some width."""

from dataclasses import dataclass
from functools import cached_property

from pydrake.multibody.plant import MultibodyPlant

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, choice_list, quantity, tag_of
from humanwalk.terrain.face import ENDLESS, Color, Face
from humanwalk.terrain.face_map import FaceMap
from humanwalk.terrain.height_map import HeightMap
from humanwalk.terrain.piece import MAX_FACES, Piece
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.slope import Flat, Slope
from humanwalk.terrain.solids import add_pictures, add_solids
from humanwalk.terrain.steps import Curb, Obstacle, Stairs, Stones
from humanwalk.terrain.terrain import GroundProperties, Surface, Terrain

PIECES: dict[str, type[Piece]] = {
    "flat": Flat,
    "slope": Slope,
    "stairs": Stairs,
    "curb": Curb,
    "rough": Rough,
    "obstacle": Obstacle,
    "stones": Stones,
    "height_map": HeightMap,
}
"""Pieces of a course by their tag in a scenario."""

FLOOR_DEPTH = 0.5
"""Depth of the ground beside the strip below the lowest piece [m]."""

SUNK = 0.1
"""Thickness of the ground beside the strip, down to the bottom of all solids [m]."""

FLOOR_COLOR: Color = (0.52, 0.55, 0.54)


@dataclass(frozen=True)
class Course(Terrain):
    """Pieces along x, each level with the one before; level ground without end before the first and after the last.

    Beside the strip the ground lies lower.
    """

    pieces: tuple[Piece, ...] = choice_list(PIECES)
    """In the order in which the walker meets them."""

    width: float = quantity(4.0, "m", 1.0, 50.0)
    """Of the strip, whose middle is y = 0."""

    run_up: float = quantity(1.0, "m", 0.5, 100.0)
    """Where the first piece begins; the walker starts at x = 0."""

    friction_coefficient: float = quantity(0.7, "", 0.05, 1.3)
    """Coulomb coefficient between sole and ground before the first and after the last piece."""

    def _level(self, begin: float, end: float, height: float) -> Face:
        """Level ground that belongs to no piece."""
        half = 0.5 * self.width
        return Face((begin, -half), (end, half), height, (0.0, 0.0), self.friction_coefficient, Flat.color)

    @cached_property
    def _map(self) -> FaceMap:
        faces, x, z = [self._level(-ENDLESS, self.run_up, 0.0)], self.run_up, 0.0
        for i, piece in enumerate(self.pieces):
            place = f"terrain.course.pieces.{i}.{tag_of(PIECES, piece)}"
            try:
                own = piece.faces(self.width)
            except ParameterError as error:
                raise ParameterError(f"{place}.{error}") from None
            faces += [face.moved(x, z) for face in own]
            if len(faces) > MAX_FACES:
                raise ParameterError(
                    f"{place}: {len(faces)} faces with those before; allowed: up to {MAX_FACES} in a course; give "
                    "fewer or coarser pieces"
                )
            x, z = x + max(face.upper[0] for face in own), z + piece.end_height
        faces.append(self._level(x, x + ENDLESS, z))
        return FaceMap(faces, self._beside(x + ENDLESS, min(face.lowest for face in faces) - FLOOR_DEPTH))

    def _beside(self, end: float, height: float) -> tuple[Face, Face]:
        """Ground to the right and left of the strip, up to an end at a height [m]."""
        half, level = 0.5 * self.width, (0.0, 0.0)
        right, left = ((-ENDLESS, -ENDLESS), (end, -half)), ((-ENDLESS, half), (end, ENDLESS))
        return (
            Face(*right, height, level, self.friction_coefficient, FLOOR_COLOR),
            Face(*left, height, level, self.friction_coefficient, FLOOR_COLOR),
        )

    @property
    def faces(self) -> tuple[Face, ...]:
        return self._map.faces

    def height(self, xy: Array) -> Array:
        return self._map.height(xy)

    def axes(self, xy: Array) -> Array:
        return self._map.axes(xy)

    def friction(self, xy: Array) -> Array:
        return self._map.friction(xy)

    def nearest(self, p_W: Array) -> Surface:
        return self._map.nearest(p_W)

    def face_at(self, xy: Array) -> Face:
        return self._map.face_at(xy)

    def faces_near(self, xy: Array, distance: float) -> tuple[Face, ...]:
        return self._map.faces_near(xy, distance)

    def add_to(self, plant: MultibodyPlant, properties: GroundProperties) -> None:
        """Register one solid for each face and for the ground on each side, and a mesh for each color."""
        faces, beside = self._map.faces, self._map.beside
        bottom = beside[0].intercept - SUNK
        add_solids(plant, (*faces, *beside), bottom, properties)
        add_pictures(plant, faces, beside, bottom)
