"""The thesis' two foot paths against the output of its programs at L 50, H 20, offset 5 cm."""

import gzip
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.gait.thesis_path import (
    backward_control_points,
    forward_control_points,
    thesis_path,
)
from humanwalk.numerics import Array, Indices

ORACLE = Path(__file__).parents[1] / "data" / "gait_oracle"
SIZES_CM = (50.0, 20.0, 5.0)
POINTS = {"forward": forward_control_points, "backward": backward_control_points}
PATHS = pytest.mark.parametrize("path", ["forward", "backward"])


def oracle(name: str) -> Any:
    file = ORACLE / name
    data = gzip.decompress(file.read_bytes()) if file.suffix == ".gz" else file.read_bytes()
    return np.genfromtxt(io.BytesIO(data), delimiter=",", names=True)


def xy(table: Any) -> Array:
    return np.column_stack([table["x_cm"], table["y_cm"]])


def dense(path: Any, sizes: Any = SIZES_CM) -> tuple[Indices, Array, Array, Array]:
    """Samples as the programs take them, 101 per segment: segment, parameter within it, point, sum of chords."""
    spline = thesis_path(path, *sizes)
    segment = np.repeat(np.arange(spline.segments), 101)
    u = np.tile(np.linspace(0.0, 1.0, 101), spline.segments)
    points = spline.position(segment + u)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return segment, u, points, np.concatenate([[0.0], np.cumsum(chords)])


def greedy_resampling(distance: Array, ds: float = 1.4, tolerance: float = 0.2) -> Indices:
    """Appendices A and B: the next dense sample whose arc from the last one is near ds (E16)."""
    chosen = [0]
    for index, arc in enumerate(distance):
        if abs(arc - distance[chosen[-1]] - ds) < tolerance:
            chosen.append(index)
    return np.array(chosen)


@PATHS
def test_control_points(path: str) -> None:
    np.testing.assert_allclose(POINTS[path](*SIZES_CM), xy(oracle(f"{path}_control_points.csv")), rtol=0, atol=1e-9)


@PATHS
def test_dense_curve(path: str) -> None:
    table, (segment, u, points, distance) = oracle(f"{path}_dense.csv.gz"), dense(path)
    np.testing.assert_array_equal(segment + 1, table["segment"])
    np.testing.assert_allclose(u, table["u"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(points, xy(table), rtol=0, atol=1e-9)
    np.testing.assert_allclose(distance, table["dist_cm"], rtol=0, atol=1e-9)


@pytest.mark.parametrize(("path", "found", "dropped"), [("forward", 218, 0), ("backward", 214, 8)])
def test_greedy_resampling_gives_the_counts_of_the_programs(path: str, found: int, dropped: int) -> None:
    """E15: 218 forward (225 printed), and 206 backward after the program's own minus 8."""
    table, (_, _, points, distance) = oracle(f"{path}_resampled.csv"), dense(path)
    chosen = greedy_resampling(distance)
    assert len(chosen) == found
    np.testing.assert_array_equal(chosen + 1, table["dense_index"])
    np.testing.assert_allclose(points[chosen], xy(table), rtol=0, atol=1e-9)
    summary = json.loads((ORACLE / f"{path}_summary.json").read_text())
    assert len(chosen) - dropped == summary["n_final"]


@PATHS
def test_greedy_resampling_gives_nine_percent_less_than_the_desired_speed(path: str) -> None:
    """E16: about 126 cm/s instead of 140."""
    *_, distance = dense(path)
    chosen = greedy_resampling(distance)
    speed_cm_s = np.diff(distance[chosen]).mean() / 0.01
    assert 125.0 < speed_cm_s < 127.0


@PATHS
def test_lengths_are_in_any_unit(path: str) -> None:
    (*_, points_cm, distance_cm), (*_, points, distance) = dense(path), dense(path, (0.5, 0.2, 0.05))
    np.testing.assert_allclose(points * 100, points_cm, atol=1e-12)
    np.testing.assert_allclose(distance * 100, distance_cm, atol=1e-10)


def test_the_two_paths_go_below_the_ground_and_differ_in_height() -> None:
    """E26, E27: why the walk uses neither of them."""
    forward, backward = (dense(path)[2][202:, 1] for path in POINTS)
    assert forward.min() == pytest.approx(-0.148, abs=1e-3)
    assert backward.min() == pytest.approx(-0.494, abs=2e-3)
    assert forward.max() == pytest.approx(22.78, abs=1e-2)
    assert backward.max() == pytest.approx(20.0, abs=1e-9)
