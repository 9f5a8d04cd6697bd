"""Maps of heights out of files: three formats, one picture; whatever else they hold is refused in one line."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from PIL import Image

from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario
from humanwalk.terrain import Course
from humanwalk.terrain.height_map import MAX_BYTES, MAX_HEIGHT, MAX_SIDE, HeightMap, read_heights

PICTURE = np.array([[0.3, 0.2, 0.1], [0.0, -0.1, -0.2]])
"""Two rows, three columns: the walk goes to the right, the first row is on its left."""


def saved(path: Path, heights: Any) -> Path:
    if path.suffix == ".npy":
        np.save(path, heights, allow_pickle=True)
    else:
        path.write_text("\n".join(",".join(str(value) for value in row) for row in heights))
    return path


def png(path: Path, gray: Any) -> Path:
    Image.fromarray(gray).save(path)
    return path


def refused(path: Path, match: str) -> None:
    with pytest.raises(ParameterError, match=match) as error:
        read_heights(path, 0.0, 1.0)
    assert str(error.value).isprintable()
    assert "allowed" in str(error.value) or "save the file again" in str(error.value)


@pytest.mark.parametrize("name", ["map.csv", "map.npy", "MAP.NPY"])
def test_numbers_are_heights(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with path.open("wb") as file:
        np.save(file, PICTURE) if name.lower().endswith("npy") else file.write(
            saved(tmp_path / "t.csv", PICTURE).read_bytes()
        )
    np.testing.assert_array_equal(read_heights(path, 5.0, 5.0), PICTURE)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("kind", ["<f8", ">f4", "i2", "u1"])
def test_npy_of_every_kind_of_number(tmp_path: Path, kind: Any, order: Any) -> None:
    heights = np.array([[0, 1, 2], [3, 4, 5]], dtype=kind, order=order)
    np.testing.assert_array_equal(read_heights(saved(tmp_path / "map.npy", heights), 0.0, 1.0), heights)


@pytest.mark.parametrize(("kind", "white"), [("u1", 255), ("<u2", 65535)])
def test_gray_reaches_from_black_to_white(tmp_path: Path, kind: Any, white: int) -> None:
    path = png(tmp_path / "map.png", np.array([[0, white], [white // 5, 0]], dtype=kind))
    np.testing.assert_allclose(read_heights(path, -0.1, 0.4), [[-0.1, 0.4], [0.0, -0.1]], atol=1e-5)


def test_the_walk_enters_the_picture_at_its_left_edge(tmp_path: Path) -> None:
    course = Course((HeightMap(file=str(saved(tmp_path / "map.csv", PICTURE)), cell_size=0.5),), width=1.0)
    for row, y in enumerate((0.25, -0.25)):
        xy = np.column_stack((1.25 + 0.5 * np.arange(3), np.full(3, y)))
        np.testing.assert_array_equal(course.height(xy), PICTURE[row])
    # Level ground follows at the height from before.
    assert course.height(np.array((2.6, 0.0))) == 0.0


@pytest.mark.parametrize(("width", "rows"), [(1.0, 2), (3.0, 2), (1.0, 7)])
def test_outermost_rows_reach_to_the_edges_and_what_is_beyond_is_left_out(
    tmp_path: Path, width: float, rows: int
) -> None:
    heights = np.linspace(0.0, 0.3, rows)[:, None] * np.ones(3)
    piece = HeightMap(file=str(saved(tmp_path / "map.npy", heights)), cell_size=0.25)
    faces = piece.faces(width)
    assert (min(face.lower[1] for face in faces), max(face.upper[1] for face in faces)) == (-0.5 * width, 0.5 * width)
    assert sum((face.upper[1] - face.lower[1]) * 0.25 for face in faces) == pytest.approx(3 * 0.25 * width)


@given(heights=hnp.arrays(float, hnp.array_shapes(min_dims=2, max_dims=2, max_side=6), elements=st.floats(-5.0, 5.0)))
def test_both_formats_of_numbers_agree(tmp_path_factory: pytest.TempPathFactory, heights: Array) -> None:
    folder = tmp_path_factory.mktemp("maps")
    for suffix in (".csv", ".npy"):
        np.testing.assert_array_equal(read_heights(saved(folder / f"map{suffix}", heights), 0.0, 1.0), heights)


def test_a_scenario_names_it_relative_to_its_folder(tmp_path: Path) -> None:
    saved(tmp_path / "map.csv", PICTURE)
    scenario = tmp_path / "mine.yaml"
    scenario.write_text("terrain: {course: {pieces: [flat, {height_map: {file: map.csv}}]}}")
    (_, piece) = load_scenario(scenario).terrain.pieces  # type: ignore[attr-defined]
    assert piece.file == str(tmp_path / "map.csv")
    assert load_scenario(scenario).terrain.height(np.array((3.05, 0.1))) == PICTURE[0, 0]


@pytest.mark.parametrize(
    ("content", "match"),
    [
        ("", "0 rows"),
        ("\n", "0 rows of 0 heights; allowed: 1 to 5000 of each; write heights$"),
        ("1,2\n3\n", r"row 2 has 1 numbers; allowed: 2"),
        ("1,x\n", r"row 1, column 2: x is not a number"),
        ("1,1_5\n", r"row 1, column 2: 1_5 is not a number"),
        ("1,nan\n", r"row 1, column 2: nan is out of range"),
        ("0,0\n0,-inf\n", r"row 2, column 2: -inf is out of range"),
        ("0,5.1\n", rf"5.1 is out of range; allowed: heights from {-MAX_HEIGHT:g} to {MAX_HEIGHT:g} m"),
        ("0\n" * (MAX_SIDE + 1), rf"{MAX_SIDE + 1} rows of 1 heights; allowed: 1 to {MAX_SIDE}"),
        ("\x1b[2J,1\n", r"x1b\[2J is not a number"),
    ],
)
def test_csv_that_is_no_map_is_refused(tmp_path: Path, content: str, match: str) -> None:
    (tmp_path / "map.csv").write_text(content)
    refused(tmp_path / "map.csv", match)


@pytest.mark.parametrize(
    ("heights", "match"),
    [
        (np.zeros(3), "two dimensions"),
        (np.zeros((2, 2, 2)), "two dimensions"),
        (np.zeros((0, 2)), "0 rows of 2"),
        (np.zeros((2, 2), complex), "array of numbers"),
        (np.array([[{"a": 1}]], dtype=object), "array of numbers"),
        (np.array([["a"]]), "array of numbers"),
        (np.array([[np.nan]]), "row 1, column 1: nan"),
        (np.zeros((2, 2), [("a", "f8")]), "array of numbers"),
    ],
    ids=str,
)
def test_npy_that_is_no_map_is_refused(tmp_path: Path, heights: Array, match: str) -> None:
    refused(saved(tmp_path / "map.npy", heights), match)


def test_npy_shorter_than_its_header_says_is_refused(tmp_path: Path) -> None:
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(file, {"descr": "<f8", "fortran_order": False, "shape": (4000, 4000)})
    path = tmp_path / "map.npy"
    path.write_bytes(file.getvalue() + b"\0" * 80)
    refused(path, "80 bytes of numbers for a shape of")


def test_image_that_is_not_gray_is_refused(tmp_path: Path) -> None:
    refused(png(tmp_path / "map.png", np.zeros((2, 2, 3), np.uint8)), "an image of mode RGB")
    refused(png(tmp_path / "map.png", np.zeros((2, 2, 4), np.uint8)), "an image of mode RGBA")


def test_image_of_too_many_pixels_is_refused_before_it_is_read(tmp_path: Path) -> None:
    refused(png(tmp_path / "map.png", np.zeros((1, MAX_SIDE + 1), np.uint8)), f"1 rows of {MAX_SIDE + 1}")


def test_damaged_image_is_refused(tmp_path: Path) -> None:
    path = png(tmp_path / "map.png", np.arange(10_000, dtype=np.uint8).reshape(100, 100))
    path.write_bytes(path.read_bytes()[:200])
    refused(path, "not a PNG image")
    path.write_bytes(b"\x89PNG\r\n\x1a\n")
    refused(path, "not a PNG image")


def test_jpeg_with_the_name_of_a_png_is_refused(tmp_path: Path) -> None:
    Image.fromarray(np.zeros((4, 4), np.uint8)).save(tmp_path / "map.png", "JPEG")
    refused(tmp_path / "map.png", "not a PNG image")
    refused(tmp_path / "map.png", "map.png: not a PNG image; allowed: a gray .png; save it again$")


@pytest.mark.parametrize("name", ["map.txt", "map", "map.csv.gz"])
def test_other_formats_are_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("0,0\n")
    refused(tmp_path / name, r"unknown format; allowed: \.csv, \.npy, \.png")


def test_missing_large_and_irregular_files_are_refused(tmp_path: Path) -> None:
    refused(tmp_path / "none.csv", "No such file")
    (tmp_path / "large.csv").write_bytes(b" " * (MAX_BYTES + 1))
    refused(tmp_path / "large.csv", f"allowed: up to {MAX_BYTES}")
    (tmp_path / "device.csv").symlink_to("/dev/zero")
    refused(tmp_path / "device.csv", "regular file")


def test_map_of_too_many_cells_is_refused_with_its_place(tmp_path: Path) -> None:
    path = saved(tmp_path / "map.npy", np.zeros((200, 200)))
    course = Course((HeightMap(file=str(path), cell_size=0.02),))
    with pytest.raises(ParameterError, match=r"^terrain\.course\.pieces\.0\.height_map\.file: 40000 faces"):
        course.height(np.zeros(2))


def test_piece_without_a_file_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"^file: no file; allowed: a \.csv, \.npy, \.png file"):
        HeightMap()


def test_error_of_a_file_has_the_place_of_its_piece(tmp_path: Path) -> None:
    course = Course((HeightMap(file=str(tmp_path / "none.csv")),))
    with pytest.raises(
        ParameterError, match=r"^terrain\.course\.pieces\.0\.height_map\.file: .*none\.csv: No such file"
    ):
        course.height(np.zeros(2))
