"""Another person: what scaling keeps, what it changes, what it refuses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import human

MASSES = st.floats(12.0, 200.0)
STATURES = st.floats(1.0, 2.2)
REFERENCE = human()


@given(mass=MASSES, stature=STATURES)
def test_mass_and_stature_are_met(mass: float, stature: float) -> None:
    body = REFERENCE.scaled(mass, stature)
    assert body.total_mass == pytest.approx(mass, rel=1e-12)
    assert body.stature == pytest.approx(stature, rel=1e-12)


@given(mass=MASSES, stature=STATURES)
def test_proportions_are_kept(mass: float, stature: float) -> None:
    body = REFERENCE.scaled(mass, stature)
    for name in ("hip_height", "leg_length", "hip_half_width"):
        ratio = getattr(body, name) / body.stature
        assert ratio == pytest.approx(getattr(REFERENCE, name) / REFERENCE.stature, rel=1e-9)
    np.testing.assert_allclose(body.com / stature, REFERENCE.com / REFERENCE.stature, atol=1e-12)
    assert [j.range_rad for j in body.joints] == [j.range_rad for j in REFERENCE.joints]
    assert [j.axis for j in body.joints] == [j.axis for j in REFERENCE.joints]


@given(mass=MASSES, stature=STATURES)
def test_inertia_goes_with_mass_and_the_square_of_length(mass: float, stature: float) -> None:
    body = REFERENCE.scaled(mass, stature)
    factor = (mass / REFERENCE.total_mass) * (stature / REFERENCE.stature) ** 2
    for segment, reference in zip(body.segments, REFERENCE.segments, strict=True):
        np.testing.assert_allclose(segment.inertia, reference.inertia * factor, rtol=1e-9)
        a, b, c = np.sort(segment.inertia)
        assert a > 0.0
        assert c < a + b


@given(mass=MASSES, stature=STATURES)
def test_torque_limits_keep_their_share_of_weight_times_stature(mass: float, stature: float) -> None:
    body = REFERENCE.scaled(mass, stature)
    for joint, reference in zip(body.joints, REFERENCE.joints, strict=True):
        share = joint.effort_limit_N_m / (mass * stature)
        assert share == pytest.approx(reference.effort_limit_N_m / (REFERENCE.total_mass * REFERENCE.stature), rel=1e-9)


@given(mass=MASSES, stature=STATURES)
def test_scaling_back_returns_the_same_person(mass: float, stature: float) -> None:
    back = REFERENCE.scaled(mass, stature).scaled(REFERENCE.total_mass, REFERENCE.stature)
    for name, p_WB in REFERENCE.origins.items():
        np.testing.assert_allclose(back.origins[name], p_WB, atol=1e-12)
    for joint, reference in zip(back.joints, REFERENCE.joints, strict=True):
        assert joint.damping == pytest.approx(reference.damping, rel=1e-9)
        assert joint.rotor_inertia == pytest.approx(reference.rotor_inertia, rel=1e-9)


@pytest.mark.parametrize("mass", [-70.0, 0.0, 11.9, 200.1, float("nan"), float("inf")])
def test_an_impossible_mass_is_named_with_its_range(mass: float) -> None:
    with pytest.raises(ValueError, match=rf"^mass: {mass:g} .*12 to 200 kg"):
        human().scaled(mass=mass, stature=1.75)


@pytest.mark.parametrize("stature", [175.0, -1.75, 0.99, 2.21, float("nan")])
def test_an_impossible_stature_is_named_with_its_range(stature: float) -> None:
    with pytest.raises(ValueError, match=rf"^stature: {stature:g} .*1 to 2\.2 m"):
        human().scaled(mass=70.0, stature=stature)
