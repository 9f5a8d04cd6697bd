"""The thesis' two foot paths against the output of its own programs at L 50, H 20, offset 5 cm."""

import gzip
import io
import json
from pathlib import Path

import numpy as np
import pytest

from humanwalk.gait.thesis_path import (
    backward_control_points,
    forward_control_points,
    thesis_curve,
)

ORACLE = Path(__file__).parents[1] / "data" / "gait_oracle"
SIZES_CM = (50.0, 20.0, 5.0)
POINTS = {"forward": forward_control_points, "backward": backward_control_points}
PATHS = pytest.mark.parametrize("path", ["forward", "backward"])


def oracle(name):
    file = ORACLE / name
    data = gzip.decompress(file.read_bytes()) if file.suffix == ".gz" else file.read_bytes()
    return np.genfromtxt(io.BytesIO(data), delimiter=",", names=True)


def xy(table):
    return np.column_stack([table["x_cm"], table["y_cm"]])


def greedy_resampling(distance, ds=1.4, tolerance=0.2):
    """Appendices A and B: the next dense sample whose arc from the last one is near ds (E16)."""
    chosen = [0]
    for index, arc in enumerate(distance):
        if abs(arc - distance[chosen[-1]] - ds) < tolerance:
            chosen.append(index)
    return np.array(chosen)


@PATHS
def test_control_points(path):
    np.testing.assert_allclose(POINTS[path](*SIZES_CM), xy(oracle(f"{path}_control_points.csv")), rtol=0, atol=1e-9)


@PATHS
def test_dense_curve(path):
    table, curve = oracle(f"{path}_dense.csv.gz"), thesis_curve(path, *SIZES_CM)
    np.testing.assert_array_equal(curve.segment + 1, table["segment"])
    np.testing.assert_allclose(curve.u, table["u"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(curve.points, xy(table), rtol=0, atol=1e-9)
    np.testing.assert_allclose(curve.distance, table["dist_cm"], rtol=0, atol=1e-9)


@pytest.mark.parametrize(("path", "found", "dropped"), [("forward", 218, 0), ("backward", 214, 8)])
def test_greedy_resampling_gives_the_counts_of_the_programs(path, found, dropped):
    """E15: 218 forward (225 printed), and 206 backward after the program's own minus 8."""
    table, curve = oracle(f"{path}_resampled.csv"), thesis_curve(path, *SIZES_CM)
    chosen = greedy_resampling(curve.distance)
    assert len(chosen) == found
    np.testing.assert_array_equal(chosen + 1, table["dense_index"])
    np.testing.assert_allclose(curve.points[chosen], xy(table), rtol=0, atol=1e-9)
    summary = json.loads((ORACLE / f"{path}_summary.json").read_text())
    assert len(chosen) - dropped == summary["n_final"]


@PATHS
def test_greedy_resampling_walks_nine_per_cent_too_slowly(path):
    """E16: about 126 cm/s where 140 were meant."""
    distance = thesis_curve(path, *SIZES_CM).distance
    chosen = greedy_resampling(distance)
    speed_cm_s = np.diff(distance[chosen]).mean() / 0.01
    assert 125.0 < speed_cm_s < 127.0


@PATHS
def test_lengths_are_in_any_unit(path):
    centimetres, metres = thesis_curve(path, 50, 20, 5), thesis_curve(path, 0.5, 0.2, 0.05)
    np.testing.assert_allclose(metres.points * 100, centimetres.points, atol=1e-12)
    np.testing.assert_allclose(metres.distance * 100, centimetres.distance, atol=1e-10)


def test_the_two_paths_dip_below_the_ground_and_differ_in_height():
    """E26, E27: why neither is walked as it stands."""
    forward, backward = (thesis_curve(p, *SIZES_CM).points[202:, 1] for p in POINTS)
    assert forward.min() == pytest.approx(-0.148, abs=1e-3)
    assert backward.min() == pytest.approx(-0.494, abs=2e-3)
    assert forward.max() == pytest.approx(22.78, abs=1e-2)
    assert backward.max() == pytest.approx(20.0, abs=1e-9)
