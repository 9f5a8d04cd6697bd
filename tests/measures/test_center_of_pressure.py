"""The path of the center of pressure of constructed stances."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from humanwalk.measures.center_of_pressure import backward_travel, backward_travels, cop_paths
from humanwalk.measures.events import events_of
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array

STRIDE = 1.0
"""Duration of a stride of the constructed walk [s], see conftest.py; the stance takes 60 % of it."""


def path(*points: tuple[float, float]) -> Array:
    """A CoP through points (gait cycle [%], forward [m]), sampled every half percent."""
    cycle = np.arange(0.0, 60.5, 0.5)
    at, forward = np.array(points).T
    return np.column_stack([cycle, np.interp(cycle, at, forward), np.zeros_like(cycle)])


def test_cop_that_runs_back_3_cm_measures_3_cm() -> None:
    assert backward_travel(path((0, -0.05), (30, 0.10), (40, 0.07), (60, 0.16))) == pytest.approx(0.03)


def test_cop_that_goes_from_heel_to_toe_measures_nothing() -> None:
    assert backward_travel(path((0, -0.05), (60, 0.16))) == 0.0


def test_backward_runs_of_heel_strike_and_of_the_unloaded_foot_do_not_count() -> None:
    assert backward_travel(path((0, 0.05), (8, -0.05), (56, 0.16), (60, 0.0))) == pytest.approx(0.0, abs=1e-12)


def test_several_runs_add_up_as_far_as_the_foremost_place() -> None:
    """Back 2 cm, forward 1 cm, back 2 cm: 3 cm behind the foremost place."""
    assert backward_travel(path((10, 0.10), (20, 0.08), (30, 0.09), (40, 0.07), (60, 0.07))) == pytest.approx(0.03)


@given(shift=st.floats(-1.0, 1.0), forward=st.lists(st.floats(-0.1, 0.2), min_size=2, max_size=8))
def test_backward_travel_does_not_depend_on_where_the_foot_is(shift: float, forward: list[float]) -> None:
    points = list(zip(np.linspace(0, 60, len(forward)), forward, strict=True))
    moved = [(cycle, place + shift) for cycle, place in points]
    assert backward_travel(path(*points)) == pytest.approx(backward_travel(path(*moved)), abs=1e-9)
    assert 0.0 <= backward_travel(path(*points)) <= np.ptp(forward) + 1e-12


def test_a_foot_without_load_has_no_backward_travel() -> None:
    assert backward_travels([np.empty((0, 3))]).tolist() == [0.0]


def run_back(signals: pa.Table, by: float) -> pa.Table:
    """The record in which the CoP of the right foot falls back by a distance [m] at 40 % of every cycle."""
    name = "right_foot.cop_x_m"
    phase = signals[TIME].to_numpy() / STRIDE % 1.0
    back = np.interp(phase, [0.0, 0.35, 0.36, 0.40, 0.401, 1.0], [0.0, 0.0, by, by, 0.0, 0.0])
    return signals.set_column(signals.column_names.index(name), name, [signals[name].to_numpy() - back])


def test_path_of_a_walk_is_in_the_frame_of_the_footprint(walk: Callable[..., Any]) -> None:
    signals = walk()
    paths = cop_paths(signals, "Right", events_of(signals, "Right"))
    assert len(paths) == 7
    for each in paths:
        assert each[0, 0] == pytest.approx(0.0, abs=1.0)
        assert each[-1, 0] == pytest.approx(60.0, abs=1.0)
        # It rolls by 0.2 m on a foot that points a few degrees off the way.
        assert np.ptp(each[:, 1]) == pytest.approx(0.2, rel=0.05)
        assert backward_travel(each) < 1e-6


def test_heading_of_the_walk_does_not_matter(walk: Callable[..., Any]) -> None:
    """The whole walk turned by 15 degrees has the same paths."""
    signals, turn = walk(), Rotation.from_euler("z", 15.0, degrees=True)
    turned = {name: signals[name].to_numpy() for name in signals.column_names}
    for point in ("right_foot.cop_", "right_sole."):
        columns = [f"{point}{axis}_m" for axis in "xyz"]
        turned |= zip(columns, turn.apply(matrix(signals, columns)).T, strict=True)
    quaternion = [f"pelvis.quaternion_{axis}" for axis in "xyzw"]
    turned |= zip(quaternion, (turn * Rotation.from_quat(matrix(signals, quaternion))).as_quat().T, strict=True)
    there = cop_paths(pa.table(turned), "Right", events_of(signals, "Right"))
    for a, b in zip(cop_paths(signals, "Right", events_of(signals, "Right")), there, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-9)


def test_run_back_of_a_walk_is_measured_stride_by_stride(walk: Callable[..., Any]) -> None:
    signals = run_back(walk(), 0.05)
    right, left = (backward_travels(cop_paths(signals, side, events_of(signals, side))) for side in ("Right", "Left"))
    # While it falls back, the CoP of the constructed walk rolls forward.
    assert right == pytest.approx(0.05, abs=0.01)
    assert left == pytest.approx(0.0, abs=1e-6)
