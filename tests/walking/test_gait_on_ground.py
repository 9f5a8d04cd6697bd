"""The thesis' walk on ground: feet stand within faces, swings clear, the pelvis climbs; level walks do not change."""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.body.contact import sole_extent
from humanwalk.body.skeleton import Skeleton
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import FootTarget, GaitTarget, WalkingGait
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.sides import SIDES, Side
from humanwalk.terrain import Course, Plane, Terrain
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.slope import Flat, Slope
from humanwalk.terrain.steps import Curb, Obstacle, Stairs
from humanwalk.walking.gait_on_ground import GaitOnGround

RAMP = SpeedRamp(0.5, 0.5)
TREAD, RISE, NUMBER = 0.3, 0.15, 4
PATH = FootPathParameters(step_length=0.36, offset=0.03)
TIMES = np.linspace(0.0, 9.0, 451)
FLIGHT = {
    direction: Course(pieces=(Stairs(rise=RISE, tread=TREAD, number=NUMBER, direction=direction),), run_up=1.128)
    for direction in ("up", "down")
}
GROUNDS: dict[str, Terrain] = {
    **FLIGHT,
    "ramp": Course(pieces=(Slope(slope=0.1, length=2.0), Flat(length=0.5), Slope(slope=-0.1, length=2.0))),
    "across": Course(pieces=(Slope(cross_slope=0.07, length=4.0),)),
    "rough": Course(pieces=(Rough(height=0.03, cell_size=0.6, seed=3),)),
    "curb": Course(pieces=(Curb(height=0.1), Curb(height=0.1, direction="down"))),
    "obstacle": Course(pieces=(Obstacle(height=0.1),)),
}
slopes = st.floats(-0.09, 0.09)


def walk_on(
    terrain: Terrain, skeleton: Skeleton, path: FootPathParameters = PATH, first: Side = "Right"
) -> GaitOnGround:
    return GaitOnGround(path, RAMP, first, terrain, skeleton)


def feet(target: GaitTarget) -> tuple[FootTarget, FootTarget]:
    return target.right, target.left


def motion_of_feet(walk: GaitOnGround) -> Iterator[tuple[GaitTarget, FootTarget]]:
    """Each foot at each of TIMES."""
    for t in TIMES:
        target = walk.target(t)
        for foot in feet(target):
            yield target, foot


def in_world(target: GaitTarget, foot: FootTarget, path: FootPathParameters = PATH) -> Array:
    """Ankle of a sole over the ground: the pelvis is at its distance, and lower than in standing by its drop."""
    return foot.position + np.array([target.pelvis.distance, 0.0, path.offset - target.pelvis.drop])


def velocity_in_world(target: GaitTarget, foot: FootTarget) -> Array:
    return foot.velocity + np.array([target.pelvis.speed, 0.0, -target.pelvis.drop_rate])


def sole_points(target: GaitTarget, foot: FootTarget, skeleton: Skeleton) -> Array:
    """Points of the sole in W [m], shape (n, 3)."""
    sole, (a, b) = sole_extent(skeleton), (foot.pitch, foot.roll)
    x, y = np.meshgrid(np.linspace(-sole.back, sole.front, 9), np.linspace(-sole.half_width, sole.half_width, 3))
    R = np.array([[np.cos(a), 0.0, np.sin(a)], [0.0, 1.0, 0.0], [-np.sin(a), 0.0, np.cos(a)]]) @ np.array(
        [[1.0, 0.0, 0.0], [0.0, np.cos(b), -np.sin(b)], [0.0, np.sin(b), np.cos(b)]]
    )
    return in_world(target, foot) + np.stack((x.ravel(), y.ravel(), 0.0 * x.ravel()), axis=1) @ R.T


@pytest.mark.parametrize("terrain", [Plane(), Course(pieces=(Flat(),))], ids=["plane", "course"])
@pytest.mark.parametrize("first", SIDES)
def test_on_level_ground_every_bit_is_that_of_the_level_walk(terrain: Terrain, first: Side, skeleton: Skeleton) -> None:
    path = FootPathParameters()
    level, placed = WalkingGait(path, skeleton.hip_half_width, RAMP, first), walk_on(terrain, skeleton, path, first)
    assert all(placed.target(t) == level.target(t) for t in TIMES)


@pytest.mark.parametrize("name", GROUNDS)
def test_every_foothold_has_the_whole_sole_on_one_face(name: str, skeleton: Skeleton) -> None:
    walk, sole = walk_on(GROUNDS[name], skeleton), sole_extent(skeleton)
    corners = np.array([[x, y] for x in (-sole.back, sole.front) for y in (-sole.half_width, sole.half_width)])
    for step in range(16):
        for foothold in walk.footholds(step).values():
            at = np.array((foothold.position.real, foothold.position.imag))
            assert (foothold.face.margin(at + corners) >= -1e-9).all()
            assert foothold.ground == pytest.approx(float(GROUNDS[name].height(at)), abs=1e-12)


@pytest.mark.parametrize("direction, sign", [("up", 1.0), ("down", -1.0)])
def test_on_stairs_a_step_is_a_tread(direction: str, sign: float, skeleton: Skeleton) -> None:
    walk = walk_on(FLIGHT[direction], skeleton)
    heights = [max(sign * foot.ground for foot in walk.footholds(step).values()) for step in range(12)]
    assert heights == pytest.approx([RISE * np.clip(step - 3, 0, NUMBER) for step in range(12)])


@pytest.mark.parametrize("name", GROUNDS)
def test_a_sole_at_mid_stance_lies_at_rest_on_the_ground(name: str, skeleton: Skeleton) -> None:
    walk = walk_on(GROUNDS[name], skeleton)
    for target, foot in motion_of_feet(walk):
        # The heel may rise in the second half.
        if foot.in_stance and foot.phase <= 0.5 * PATH.duty_factor:
            np.testing.assert_allclose(velocity_in_world(target, foot), 0.0, atol=1e-9)
            points = sole_points(target, foot, skeleton)
            np.testing.assert_allclose(points[:, 2], GROUNDS[name].height(points[:, :2]), atol=1e-9)


@pytest.mark.parametrize("name", GROUNDS)
def test_a_swinging_sole_does_not_touch_the_ground(name: str, skeleton: Skeleton) -> None:
    """Up to 1 cm: the level path may have the toes 3 mm in the ground, and the lift is smoothed near the footholds."""
    walk = walk_on(GROUNDS[name], skeleton)
    for target, foot in motion_of_feet(walk):
        points = sole_points(target, foot, skeleton)
        assert (points[:, 2] - GROUNDS[name].height(points[:, :2])).min() > -0.01


@pytest.mark.parametrize("name", GROUNDS)
def test_velocities_are_the_rates_of_the_poses(name: str, skeleton: Skeleton) -> None:
    walk, h = walk_on(GROUNDS[name], skeleton), 1e-5
    for t in TIMES[1::7]:
        now, after, before = (walk.target(time) for time in (t, t + h, t - h))
        assert now.pelvis.drop_rate == pytest.approx((after.pelvis.drop - before.pelvis.drop) / (2 * h), abs=1e-3)
        for foot, later, earlier in zip(*map(feet, (now, after, before)), strict=True):
            rates = np.subtract(
                (*later.position, later.pitch, later.roll), (*earlier.position, earlier.pitch, earlier.roll)
            )
            found = (*foot.velocity, foot.pitch_rate, foot.roll_rate)
            np.testing.assert_allclose(found, rates / (2 * h), rtol=0, atol=5e-3)


@settings(max_examples=15)
@given(slope=slopes, cross_slope=slopes)
def test_on_a_slope_the_pelvis_climbs_as_far_as_the_ground(
    slope: float, cross_slope: float, skeleton: Skeleton
) -> None:
    walk = walk_on(Plane(slope=slope, cross_slope=cross_slope), skeleton)
    first, last = (walk.pelvis(t) for t in (4.0, 7.0))
    climbed = (last.distance - first.distance) * np.tan(slope)
    assert first.drop - last.drop == pytest.approx(climbed, abs=1e-9)


@pytest.mark.parametrize("direction, sign", [("up", 1.0), ("down", -1.0)])
def test_behind_stairs_the_pelvis_is_higher_or_lower_by_their_height(
    direction: str, sign: float, skeleton: Skeleton
) -> None:
    walk = walk_on(FLIGHT[direction], skeleton)
    assert walk.rise(5.0).value == pytest.approx(sign * NUMBER * RISE, abs=1e-9)
    assert walk.rise(0.25).value == 0.0


@pytest.mark.parametrize("name", ["up", "down", "ramp", "across", "curb"])
def test_no_standing_leg_extends_farther_than_on_level_ground(name: str, skeleton: Skeleton) -> None:
    """The spline between two heights may be 1 cm above their line."""
    walk, ankle_height = walk_on(GROUNDS[name], skeleton), skeleton.hip_height - skeleton.leg_length
    longest = np.hypot(0.5 * PATH.step_length, skeleton.hip_height - PATH.offset - ankle_height)
    for t in TIMES[np.searchsorted(TIMES, walk.start_time) :]:
        target = walk.target(t)
        for side, foot in zip((-1.0, 1.0), feet(target), strict=True):
            if foot.in_stance:
                up = ankle_height * np.array((np.sin(foot.pitch), 0.0, np.cos(foot.pitch)))
                hip = np.array((0.0, side * skeleton.hip_half_width, skeleton.hip_height - PATH.offset))
                assert np.linalg.norm(foot.position + up - hip) < longest + 0.01


@pytest.mark.parametrize("direction", ["up", "down"])
def test_on_stairs_the_heel_rises_about_the_toes_before_lift_off(direction: str, skeleton: Skeleton) -> None:
    walk, front = walk_on(FLIGHT[direction], skeleton), sole_extent(skeleton).front
    toes, pitches = [], []
    for d in np.linspace(6.0, 6.0 + PATH.duty_factor, 25) * TREAD:
        # The stance of the foot that lands at foothold 6 has its middle at this distance.
        target = walk.target(walk.ramp.time_at(float(d)))
        foot = target.left
        toes.append(in_world(target, foot) + front * np.array((np.cos(foot.pitch), 0.0, -np.sin(foot.pitch))))
        pitches.append(foot.pitch)
    np.testing.assert_allclose(toes, np.broadcast_to(toes[0], (25, 3)), atol=1e-9)
    assert pitches == sorted(pitches)
    assert (pitches[0], pitches[-1]) == pytest.approx((0.0, np.arctan2(RISE, TREAD)), abs=0.02)


def test_a_step_that_does_not_fit_the_treads_is_rejected_whenever_it_is_asked_for(skeleton: Skeleton) -> None:
    walk = walk_on(FLIGHT["up"], skeleton, FootPathParameters())
    messages = []
    for _ in range(2):
        with pytest.raises(ParameterError, match="has no foothold for step") as error:
            walk.footholds(40)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_a_step_that_does_not_fit_the_treads_is_rejected_with_the_one_that_does(skeleton: Skeleton) -> None:
    walk = walk_on(FLIGHT["up"], skeleton, FootPathParameters())
    with pytest.raises(ParameterError, match=r"step_length: 0\.5 has no foothold for step \d.*set it to 1\.2 times"):
        walk.footholds(9)
