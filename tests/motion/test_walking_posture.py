"""The height of the center of mass in walking follows from the proportions of the body, relative to the default man."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.body.devices import AnkleProsthesis
from humanwalk.body.impairments import StiffKnee
from humanwalk.body.loads import Backpack
from humanwalk.body.subject import Subject
from humanwalk.choices.balanced import BalancedController
from humanwalk.motion.walking_posture import height_ratio

WOMEN = 0.997
"""Ratio of de Leva's women."""


@settings(max_examples=15)
@given(stature=st.floats(1.4, 2.1), body_mass_index=st.floats(17.0, 35.0))
def test_bodies_of_equal_proportions_have_equal_ratios(stature: float, body_mass_index: float) -> None:
    mass = body_mass_index * stature**2
    assert height_ratio(Subject(mass, stature, "male")) == 1.0
    assert height_ratio(Subject(mass, stature, "female")) == WOMEN


@pytest.mark.parametrize(
    "subject",
    [
        Subject(impairments=(StiffKnee(0.3),)),
        Subject(devices=(AnkleProsthesis(),)),
        Subject(loads=(Backpack(mass=20.0),)),
    ],
    ids=["impairment", "device", "load"],
)
def test_impairments_devices_and_loads_do_not_count(subject: Subject) -> None:
    assert height_ratio(subject) == 1.0


def test_longer_feet_and_shorter_legs_carry_the_body_higher(tmp_path: Path) -> None:
    def ratio(segment: str, length: float) -> float:
        path = tmp_path / f"{segment}.csv"
        path.write_text(f"segment,length_m\n{segment},{length}\n")
        return height_ratio(Subject(measured=str(path)))

    assert ratio("foot", 0.22) < 1.0 < ratio("foot", 0.30)
    assert ratio("shank", 0.47) < ratio("shank", 0.39)


def test_the_planner_walks_at_this_height() -> None:
    controller = BalancedController()
    heights = [controller.fitted(Subject(sex=sex)).planner.height for sex in ("male", "female")]
    assert [height.walking for height in heights] == [
        controller.planner.height.walking,
        WOMEN * controller.planner.height.walking,
    ]
    assert heights[0].standing == heights[1].standing
