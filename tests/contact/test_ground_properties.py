"""Drake combines sole and ground to the terrain's coefficient of friction."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.plant import CalcContactFrictionFromSurfaceProperties, CoulombFriction

from humanwalk.body.contact import FRICTION
from humanwalk.contact.ground_properties import ground_properties

SOLE = CoulombFriction(FRICTION, FRICTION)


@given(friction=st.floats(0.0, 1.3))
def test_sole_and_ground_have_the_terrains_coefficient(friction: float) -> None:
    ground = ground_properties(friction).GetProperty("material", "coulomb_friction")
    together = CalcContactFrictionFromSurfaceProperties(SOLE, ground)
    assert together.static_friction() == pytest.approx(friction)
    assert together.dynamic_friction() == pytest.approx(friction)


@pytest.mark.parametrize("friction", [-0.1, 2.0 * FRICTION, 3.0])
def test_a_coefficient_that_no_ground_has_with_the_sole_is_refused(friction: float) -> None:
    with pytest.raises(ValueError, match=rf"^friction: {friction:g} is out of range; allowed: 0 to below 1\.4"):
        ground_properties(friction)


@pytest.mark.parametrize("hydroelastic", [False, True])
def test_ground_is_rigid_for_pressure_fields_where_these_are_used(hydroelastic: bool) -> None:
    assert ground_properties(0.7, hydroelastic).HasProperty("hydroelastic", "compliance_type") is hydroelastic
