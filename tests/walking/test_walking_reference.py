"""The feet of the measured state share the load of the body."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.walking.walking_reference import BodyState, FootState

forces = st.floats(-500.0, 3000.0)


def body(right: float, left: float) -> BodyState:
    return BodyState(0j, 0j, 0.93, loaded(right), loaded(left))


def loaded(force: float) -> FootState:
    return FootState(0j, 0j, 0.07, 0.0, 0.0, 0.0, 0.0, force)


@given(forces, forces)
def test_the_shares_of_both_feet_make_the_load_in_proportion_to_their_forces(right: float, left: float) -> None:
    """Contact that dissipates energy may pull at a foot; it carries nothing then."""
    shares = body(right, left).load_share("Right"), body(right, left).load_share("Left")
    loads = max(right, 0.0), max(left, 0.0)
    assert all(0.0 <= share <= 1.0 for share in shares)
    assert sum(shares) == (pytest.approx(1.0) if max(loads) > 0.0 else 0.0)
    assert shares[0] * loads[1] == pytest.approx(shares[1] * loads[0])
