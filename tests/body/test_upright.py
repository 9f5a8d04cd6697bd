"""Upright standing of bodies with unequal legs and stiff joints."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import human
from humanwalk.body.devices import AnkleProsthesis
from humanwalk.body.impairments import HipContracture, ShortLeg, StiffKnee
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import body_plant
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.body.upright import knee_flexions, passive_ankles, upright
from humanwalk.sides import SIDES, Side


def height(skeleton: Skeleton, side: Side, knee: float) -> float:
    """Height of a hip above the ankle, hip and ankle flexed by half of the knee's flexion [m]."""
    leg = LEGS[side]
    return -(skeleton.joint(leg.knee).origin[2] + skeleton.joint(leg.ankle).origin[2]) * math.cos(0.5 * knee)


def test_equal_legs_are_bent_alike() -> None:
    assert knee_flexions(human(), 0.24) == {"Right": 0.24, "Left": 0.24}


@given(shortening=st.floats(0.001, 0.1), side=st.sampled_from(SIDES), flexion=st.floats(0.05, 0.5))
def test_the_hips_are_level_above_unequal_legs(shortening: float, side: Side, flexion: float) -> None:
    body = ShortLeg(shortening, side).applied(human())
    knees = knee_flexions(body, flexion)
    assert knees[side] == flexion
    assert height(body, "Right", knees["Right"]) == pytest.approx(height(body, "Left", knees["Left"]))


@given(angle=st.floats(0.01, 1.0), flexion=st.floats(0.05, 0.5))
def test_a_healthy_knee_bends_like_a_locked_one(angle: float, flexion: float) -> None:
    knees = knee_flexions(StiffKnee(angle, side="Left").applied(human()), flexion)
    assert knees["Left"] == pytest.approx(angle, abs=0.001)
    assert knees["Right"] == pytest.approx(angle, abs=0.001)


def test_a_knee_bends_where_the_hip_does_not_straighten() -> None:
    assert knee_flexions(HipContracture(0.25).applied(human()), 0.1)["Right"] == pytest.approx(0.5)


def test_the_shorter_leg_counts_on_either_side() -> None:
    healthy = upright(body_plant(Subject()))
    for side in SIDES:
        short = upright(body_plant(Subject(impairments=(ShortLeg(0.03, side),))))
        assert short.leg_length == pytest.approx(healthy.leg_length - 0.03)
        assert short.ankle_height == pytest.approx(healthy.ankle_height)
        # The lighter shank raises the center of mass by less than 4 mm.
        assert short.com_height == pytest.approx(healthy.com_height - 0.03, abs=0.004)


def test_a_prosthesis_leaves_its_ankle_without_muscles() -> None:
    assert passive_ankles(body_plant(Subject())) == ()
    assert passive_ankles(body_plant(Subject(devices=(AnkleProsthesis(side="Left"),)))) == ("Left",)


def test_a_knee_locked_in_flexion_makes_a_leg_shorter() -> None:
    healthy = upright(body_plant(Subject()))
    for angle in (0.3, 0.6):
        locked = upright(body_plant(Subject(impairments=(StiffKnee(angle),))))
        # Of two parts of about equal length.
        assert locked.leg_length == pytest.approx(healthy.leg_length * math.cos(0.5 * angle), rel=0.001)
        assert locked.com_height == pytest.approx(healthy.com_height - healthy.leg_length + locked.leg_length)
