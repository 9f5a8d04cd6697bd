"""People's curves are those of the source, and the group that walks at a dimensionless speed is found."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.gait.normative import PEOPLE_LEG, SPEED_GROUPS, dimensionless_speed, is_measured, speed_group
from humanwalk.measures.curves import ANGLES, CURVES, MOMENTS, POWERS


@pytest.mark.parametrize("group", SPEED_GROUPS)
@pytest.mark.parametrize("name", CURVES)
def test_curves_close_and_have_a_spread(name: str, group: str) -> None:
    band = CURVES[name].people(group)  # type: ignore[arg-type]
    assert band.sd.min() > 0.0
    # Heel strike ends the cycle that it begins.
    assert abs(band.mean[0] - band.mean[-1]) < 0.35 * np.ptp(band.mean)


def test_curves_have_the_landmarks_of_textbooks() -> None:
    knee, ankle, power = (CURVES[name].people("free").mean for name in ("knee", "ankle moment", "ankle power"))
    assert 65 <= knee.argmax() <= 80
    assert 50.0 < knee.max() < 70.0
    # Plantarflexors carry the body in late stance, and push off after.
    assert 40 <= ankle.argmax() <= 55
    assert 1.0 < ankle.max() < 1.6
    assert ankle.argmax() < power.argmax() <= 60


def test_faster_people_move_more() -> None:
    for name in ("hip", "hip moment", "knee power"):
        ranges = [np.ptp(CURVES[name].people(group).mean) for group in SPEED_GROUPS]
        assert ranges == sorted(ranges), name


def test_the_pelvic_plane_of_people_leans_forward() -> None:
    assert 8.0 < ANGLES["pelvis tilt"].people("free").mean.mean() < 14.0


def test_moments_are_in_newton_meters_per_kilogram() -> None:
    for curve in MOMENTS.values():
        assert 0.1 < np.abs(curve.people("free").mean).max() < 2.0


@given(leg=st.floats(0.5, 1.1))
def test_moments_and_powers_are_those_of_dynamically_similar_bodies(leg: float) -> None:
    """Per body mass, moments are in proportion to the leg length, powers to its square root; angles are the same."""
    for name, curve in CURVES.items():
        exponent = 1.0 if name in MOMENTS else 0.5 if name in POWERS else 0.0
        scaled, people = curve.people("free", leg), curve.people("free")
        factor = (leg / PEOPLE_LEG) ** exponent
        assert scaled.mean == pytest.approx(factor * people.mean), name
        assert scaled.sd == pytest.approx(factor * people.sd), name


@given(froude=st.floats(0.0, 2.0))
def test_group_is_the_one_that_contains_the_speed_or_the_nearest(froude: float) -> None:
    low, _ = SPEED_GROUPS[speed_group(froude)]
    inside = [name for name, (a, b) in SPEED_GROUPS.items() if a <= froude <= b]
    assert is_measured(froude) == bool(inside)
    if inside:
        assert speed_group(froude) in inside
    else:
        assert speed_group(froude) == ("slow" if froude < low else "fast")


@pytest.mark.parametrize(
    ("speed", "group"), [(0.9, "slow"), (1.0, "slow"), (1.2, "free"), (1.4, "free"), (1.7, "fast")]
)
def test_groups_of_a_leg_of_93_centimeters(speed: float, group: str) -> None:
    assert speed_group(dimensionless_speed(speed, 0.93)) == group
    # A body with half the leg walks as fast at 71 % of the speed.
    assert speed_group(dimensionless_speed(speed / 2**0.5, 0.93 / 2)) == group
