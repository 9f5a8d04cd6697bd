"""The rotation vector from one frame to another is Drake's, whatever the two are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.math import RollPitchYaw, RotationMatrix

from humanwalk.numerics.rotation import rotation_vector

angles = st.floats(-3.1, 3.1)
rotations = st.builds(lambda r, p, y: RotationMatrix(RollPitchYaw(r, p, y)).matrix(), angles, angles, angles)


@given(rotations, rotations)
def test_it_takes_the_one_frame_to_the_other(start, goal):
    vector = np.array(rotation_vector(start.T.tolist(), goal.T.tolist()))
    turn = RotationMatrix(goal @ start.T).ToAngleAxis()
    # Half a turn is the same about either end of its axis.
    either = (turn.angle() * turn.axis(), (turn.angle() - 2.0 * np.pi) * turn.axis())
    assert min(np.abs(vector - one).max() for one in either) < 1e-6


@given(rotations)
def test_from_a_frame_to_itself_there_is_nothing(frame):
    assert rotation_vector(frame.T.tolist(), frame.T.tolist()) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
