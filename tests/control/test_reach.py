"""The legs' reach of the thesis' walk on a terrain is tried before the walk."""

import pytest

from humanwalk.body.subject import Subject
from humanwalk.control.inverse_kinematics import InverseKinematicsParameters
from humanwalk.control.reach import require_reachable_on
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.quantity import ParameterError
from humanwalk.terrain import Course, Plane, Terrain
from humanwalk.terrain.steps import Stairs
from humanwalk.walking.gait_on_ground import GaitOnGround

TREADS = FootPathParameters(step_length=0.36, offset=0.03)


def try_walk(terrain: Terrain, path: FootPathParameters, speed: float = 1.0) -> None:
    subject = Subject()
    walk = GaitOnGround(path, SpeedRamp(speed, 0.5), "Right", terrain, subject.skeleton)
    require_reachable_on(terrain, subject, walk, InverseKinematicsParameters())


def stairs(rise: float, begin: float = 1.128) -> Course:
    return Course(pieces=(Stairs(rise=rise, tread=0.3, number=3),), run_up=begin)


@pytest.mark.parametrize("terrain", [Plane(slope=0.0873), Plane(slope=-0.0873), Plane(cross_slope=0.07)])
def test_slopes_of_five_and_four_degrees_are_within_reach(terrain: Terrain) -> None:
    try_walk(terrain, FootPathParameters())


def test_stairs_of_15_cm_are_within_reach() -> None:
    try_walk(stairs(0.15), TREADS)


def test_a_slope_for_which_the_ankles_do_not_bend_is_rejected_in_one_line() -> None:
    with pytest.raises(
        ParameterError, match=r"on this terrain, in step 1, .* deg off its path, with .*Ankle.*change step_length"
    ) as error:
        try_walk(Plane(slope=0.35), FootPathParameters())
    assert "\n" not in str(error.value)


def test_stairs_higher_than_the_feet_go_are_rejected() -> None:
    with pytest.raises(ParameterError, match="has no foothold for step 4"):
        try_walk(stairs(0.3), TREADS)


def test_a_body_that_stands_need_not_reach_what_is_far_away() -> None:
    try_walk(stairs(0.3, begin=3.0), TREADS, speed=0.0)
