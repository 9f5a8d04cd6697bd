"""A piece of a course out of a file with heights: boxes as the pixels of a map seen from above.

The file may come from anybody: its size, its format and every number in it are checked.
"""

import io
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from PIL import Image, UnidentifiedImageError

from humanwalk.files import read_regular
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, file_path, number_of, printable, quantity
from humanwalk.terrain.face import Color, Face
from humanwalk.terrain.piece import Piece, require_few_faces

MAX_BYTES = 5_000_000
"""Largest file."""

MAX_SIDE = 5000
"""Largest number of rows and of columns."""

MAX_HEIGHT = 5.0
"""Largest magnitude of a height [m]."""

FORMATS = (".csv", ".npy", ".png")

WHITE = {"1": 1, "L": 255, "I;16": 65535, "I;16B": 65535, "I": 65535}
"""White by Pillow's modes of gray images of 1, 8 and 16 bits."""

NPY_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
"""Readers of the header of a .npy file, by the version of its format. No pickle is ever read."""


@dataclass(frozen=True)
class HeightMap(Piece):
    """Boxes with heights out of a file, seen from above: the walk enters at the left edge and goes to the right."""

    color: ClassVar[Color] = (0.58, 0.68, 0.54)

    file: str = file_path()
    """A .csv or .npy file with heights [m], or a gray .png; a relative path counts from the scenario's folder."""

    cell_size: float = quantity(0.4, "m", 0.02, 10.0)
    """Edge of a cell, one number or pixel of the file. A cell is a flat face: the balanced walker takes no foothold on
    cells that are shorter than its soles."""

    black: float = quantity(0.0, "m", -MAX_HEIGHT, MAX_HEIGHT)
    """Height of black in a .png."""

    white: float = quantity(0.1, "m", -MAX_HEIGHT, MAX_HEIGHT)
    """Height of white in a .png."""

    def __post_init__(self) -> None:
        """Raise ParameterError without a file."""
        if not self.file:
            raise ParameterError(f"file: no file; allowed: a {', '.join(FORMATS)} file; name it (file: heights.csv)")

    def faces(self, width: float) -> list[Face]:
        """See `Piece.faces`. Rows beyond the width are left out; the outermost rows reach to the edges."""
        try:
            heights = read_heights(Path(self.file), self.black, self.white)[::-1].T
        except ParameterError as error:
            raise ParameterError(f"file: {error}") from None
        columns, rows = heights.shape
        xs = self.cell_size * np.arange(columns + 1.0)
        edges = self.cell_size * (np.arange(rows + 1.0) - 0.5 * rows)
        edges[0], edges[-1] = min(edges[0], -0.5 * width), max(edges[-1], 0.5 * width)
        ys = np.clip(edges, -0.5 * width, 0.5 * width)
        kept = np.flatnonzero(np.diff(ys) > 0.0)
        require_few_faces(columns * kept.size, "file", "give a coarser map")
        return [
            self.face((xs[i], xs[i + 1]), (ys[j], ys[j + 1]), float(heights[i, j]))
            for i in range(columns)
            for j in kept
        ]


def read_heights(path: Path, black: float, white: float) -> Array:
    """Read a map of heights [m], rows as in a picture seen from above, shape (rows, columns).

    Args:
        path: A .csv file of numbers without a header, a .npy file of a two-dimensional array, or a gray .png.
        black, white: Heights of black and white in a .png [m].

    Raises:
        ParameterError: The file cannot be read, or a value in it cannot be used.
    """
    name, suffix = printable(path), path.suffix.lower()
    if suffix not in FORMATS:
        raise ParameterError(f"{name}: unknown format; allowed: {', '.join(FORMATS)}; convert the file")
    content = read_regular(path, MAX_BYTES)
    if suffix == ".png":
        heights = black + (white - black) * _gray(content, name)
    else:
        heights = _csv(content, name) if suffix == ".csv" else _npy(content, name)
    if not np.isfinite(heights).all() or np.abs(heights).max() > MAX_HEIGHT:
        row, column = np.argwhere(~(np.abs(heights) <= MAX_HEIGHT))[0]
        raise ParameterError(
            f"{name}: row {row + 1}, column {column + 1}: {heights[row, column]:g} is out of range; allowed: heights "
            f"from {-MAX_HEIGHT:g} to {MAX_HEIGHT:g} m; write meters"
        )
    return heights


def _require_size(rows: int, columns: int, name: str) -> None:
    if not (1 <= rows <= MAX_SIDE and 1 <= columns <= MAX_SIDE):
        fix = "give a smaller map" if rows else "write heights"
        raise ParameterError(f"{name}: {rows} rows of {columns} heights; allowed: 1 to {MAX_SIDE} of each; {fix}")


def _csv(content: bytes, name: str) -> Array:
    try:
        lines = [line for line in content.decode("utf-8-sig").splitlines() if line.strip()]
    except UnicodeDecodeError:
        raise ParameterError(f"{name}: not UTF-8 text; allowed: numbers between commas; save it as that") from None
    columns = lines[0].count(",") + 1 if lines else 0
    _require_size(len(lines), columns, name)
    heights = np.empty((len(lines), columns))
    for row, line in enumerate(lines):
        cells = line.split(",")
        if len(cells) != columns:
            raise ParameterError(f"{name}: row {row + 1} has {len(cells)} numbers; allowed: {columns}, as in row 1")
        for column, cell in enumerate(cells):
            try:
                heights[row, column] = number_of(cell)
            except ValueError:
                raise ParameterError(
                    f"{name}: row {row + 1}, column {column + 1}: {printable(cell, 40)} is not a number; allowed: "
                    "heights in meters without a header; correct it"
                ) from None
    return heights


def _npy(content: bytes, name: str) -> Array:
    fix = f"{name}: not a NumPy array of numbers in two dimensions; allowed: one saved by numpy.save(file, heights)"
    file = io.BytesIO(content)
    try:
        # The header is checked first: it declares a size that the file may not have.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            shape, fortran_order, kind = NPY_HEADERS[np.lib.format.read_magic(file)](file)
        data = content[file.tell() :]
    except Exception:
        # NumPy lets many kinds of errors out of damaged headers, which it reads as Python.
        raise ParameterError(fix) from None
    if len(shape) != 2 or kind.kind not in "fiu" or kind.itemsize > 8:
        raise ParameterError(fix)
    _require_size(*shape, name)
    if len(data) != shape[0] * shape[1] * kind.itemsize:
        raise ParameterError(f"{name}: {len(data)} bytes of numbers for a shape of {shape}; save the file again")
    heights: Array = np.frombuffer(data, kind).reshape(shape, order="F" if fortran_order else "C").astype(float)
    return heights


def _gray(content: bytes, name: str) -> Array:
    """Gray values of a PNG image from 0 to 1, shape (rows, columns)."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            # Opening reads the header; the size is checked before the pixels are decompressed.
            with Image.open(io.BytesIO(content), formats=("PNG",)) as image:
                columns, rows = image.size
                _require_size(rows, columns, name)
                if image.mode not in WHITE:
                    raise ParameterError(
                        f"{name}: an image of mode {image.mode}; allowed: gray without transparency, of 1, 8 or 16 "
                        "bits; convert it"
                    )
                return np.asarray(image, dtype=float) / WHITE[image.mode]
    except ParameterError:
        raise
    except UnidentifiedImageError:
        # Its message has the address of an object.
        raise ParameterError(f"{name}: not a PNG image; allowed: a gray .png; save it again") from None
    except Exception as error:
        # Pillow lets many kinds of errors out of damaged files.
        raise ParameterError(
            f"{name}: not a PNG image: {printable(error)}; allowed: a gray .png; save it again"
        ) from None
