"""The frame of a step."""

import cmath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.commanded_path import PathFollowing
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.walking_reference import Phase

points = st.builds(complex, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))


def state_on(left: Foothold, heading: float) -> PlannerState:
    path = PathFollowing().begin(0.0, heading)
    right = Foothold(0.0, 0.0)
    return PlannerState(Phase.DOUBLE_SUPPORT, 0.0, "Left", right, left, 0.0, heading, heading, path, height=0.9)


@given(points, points, st.floats(-3.0, 3.0))
def test_the_frame_of_the_step_is_at_the_stance_ankle_along_the_heading(
    ankle: complex, point: complex, heading: float
) -> None:
    state = state_on(Foothold(ankle, 0.0), heading)
    assert state.world(state.local(point)) == pytest.approx(point, abs=1e-9)
    assert state.local(ankle) == pytest.approx(0.0, abs=1e-9)
    assert state.local(ankle + cmath.exp(1j * heading)) == pytest.approx(1.0, abs=1e-9)
