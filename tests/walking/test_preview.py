"""The next footholds: those of the gait on a plane, on faces elsewhere, with a speed and duration that suit them."""

import cmath
import math
from dataclasses import replace
from itertools import chain, pairwise, repeat

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.terrain import Course, Ground, Plane
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.slope import Flat
from humanwalk.terrain.steps import Stairs
from humanwalk.walking.command import Command
from humanwalk.walking.foot_placement import StepPlacement
from humanwalk.walking.footholds import Foothold, FootholdSearch
from humanwalk.walking.lipm import PeriodicGait, PerStance, ZmpSegment, backward
from humanwalk.walking.preview import STEPS, FootholdPlanner, Pacing, dcm_shift

SOLE = SoleExtent(back=0.055, front=0.211, half_width=0.048)
PLACEMENT, PACING = StepPlacement(), Pacing()
FREQUENCY = 3.2
PLANNER = FootholdPlanner(SOLE, FootholdSearch(), PLACEMENT, PACING, com_height=0.95)
STAIRS = Course(pieces=(Flat(length=0.5), Stairs(rise=0.18, tread=0.29, number=12)), run_up=0.5)


def gait(length: float, turn: float = 0.0, double: float = 0.1, single: float = 0.43) -> PeriodicGait:
    return PeriodicGait(PerStance(length - 0.16j, length + 0.16j), turn, 0.1, double, single)


def preview_on(ground: Ground, length: float, position: complex = 0.08j, turn: float = 0.0):  # type: ignore[no-untyped-def]
    return PLANNER.preview(ground, Foothold.on(ground, position), "Left", 0.0, gait(length, turn))


@given(st.floats(-0.3, 0.7), st.floats(-0.2, 0.2), st.floats(-0.1, 0.1))
def test_on_a_plane_the_footholds_are_those_of_the_gait(length: float, turn: float, slope: float) -> None:
    preview = preview_on(Plane(slope=slope), length, turn=turn)
    assert preview.is_regular
    assert preview.moves([gait(length, turn)] * STEPS, 0.08j, "Left", 1.0) == (0.0,) * STEPS
    assert preview.pace == 1.0
    assert preview.footholds[0].position == pytest.approx(0.08j + length - 0.16j)


def test_on_stairs_every_step_is_one_tread_and_the_pace_follows() -> None:
    preview = preview_on(STAIRS, 0.45, 1.0 + 0.29 * 3 + 0.06 + 0.08j)
    heights = [foothold.ground / 0.18 for foothold in preview.footholds]
    assert heights == pytest.approx([5, 6, 7])
    assert preview.pace == pytest.approx(0.29 / 0.45, rel=0.05)


@pytest.mark.parametrize("free_lead, boxes", [(0.0, [4.4, 4.4, 4.8]), (0.35, [4.4, 4.8, 5.2])])
def test_on_boxes_longer_than_a_step_the_lead_is_made_up_for_or_free(free_lead: float, boxes: list[float]) -> None:
    ground = Course(pieces=(Rough(length=8.0, cell_size=0.4, height=0.01),), run_up=0.8)
    planner = replace(PLANNER, pacing=replace(PACING, free_lead=free_lead))
    footholds = planner.preview(ground, Foothold.on(ground, 4.08 + 0.08j), "Left", 0.0, gait(0.32)).footholds
    assert [foothold.face.lower[0] for foothold in footholds] == pytest.approx(boxes)


@given(st.floats(0.1, 0.6), st.floats(0.0, 0.04), st.integers(0, 100), st.floats(0.0, 0.1))
def test_backward_steps_are_those_of_a_walker_that_faces_the_other_way(
    length: float, height: float, seed: int, ahead: float
) -> None:
    ground = Course(pieces=(Rough(length=8.0, cell_size=0.4, height=height, seed=seed),), run_up=0.8)
    sole = SoleExtent(back=0.13, front=0.13, half_width=0.048)
    planner = replace(PLANNER, sole=sole, search=FootholdSearch(heel_room=0.0))
    stance = Foothold.on(ground, 4.08 + 0.08j)
    forward = planner.preview(ground, stance, "Left", 0.0, gait(length), ahead)
    backward = planner.preview(ground, stance, "Right", math.pi, gait(-length), ahead)
    places = ([foothold.position for foothold in preview.footholds] for preview in (forward, backward))
    assert next(places) == pytest.approx(next(places))
    assert (forward.pace, forward.ahead) == pytest.approx((backward.pace, backward.ahead))


@pytest.mark.parametrize(
    "length, free, above, below",
    [(0.30, 0.0, 0.0, 0.0), (0.38, 0.0, 0.0, -0.18), (0.40, -0.18, 0.0, -0.18), (0.45, -0.18, -0.18, -0.18)],
)
def test_the_next_foothold_keeps_the_face_of_the_plan_before_unless_another_is_far_nearer(
    length: float, free: float, above: float, below: float
) -> None:
    """Before the first step down: the DCM goes to the foothold that was planned."""
    ground = Course(pieces=(Flat(length=0.5), Stairs(rise=0.18, tread=0.29, number=12, direction="down")), run_up=0.5)
    stance = Foothold.on(ground, 0.55 + 0.08j)
    floor, tread = (Foothold.on(ground, place).face for place in (0.7 - 0.08j, 1.06 - 0.08j))
    for face, height in ((None, free), (floor, above), (tread, below)):
        preview = PLANNER.preview(ground, stance, "Left", 0.0, gait(length), current=face)
        assert preview.footholds[0].ground == pytest.approx(height)


def test_on_ice_the_steps_are_short() -> None:
    ice = preview_on(Plane(friction_coefficient=0.15), 0.5)
    assert ice.pace < 0.6
    step = ice.footholds[0].position - 0.08j
    assert abs(step) / 2.0 / 0.95 <= PACING.friction_use * 0.15 + 1e-9


moves = st.lists(st.floats(-0.5, 0.5), min_size=1, max_size=STEPS)
durations = st.lists(st.tuples(st.floats(0.05, 0.2), st.floats(0.3, 0.6)), min_size=1, max_size=STEPS)


@given(st.floats(0.2, 0.6), moves, durations)
def test_the_shift_of_the_dcm_is_that_of_the_displaced_zero_moment_points(
    length: float, increments: list[float], times: list[tuple[float, float]]
) -> None:
    """Footholds displaced with all after them, in steps of different duration, against the pendulum over many steps."""

    def dcm(*displacements: float) -> complex:
        feet = [0.0]
        for displacement in (*displacements, *(0.0,) * 40):
            feet.append(feet[-1] + length + displacement)
        segments = []
        for (old, new), (double, single) in zip(pairwise(feet), chain(times, repeat(times[-1])), strict=False):
            segments += [ZmpSegment(old, new, double), ZmpSegment(new, new, single)]
        return backward(tuple(segments), feet[-1], FREQUENCY)

    following = [gait(length, 0.0, *step) for step in times]
    shift = dcm(*increments) - dcm(*(0.0 for _ in increments))
    assert shift == pytest.approx(dcm_shift(increments, following, FREQUENCY), abs=1e-9)


@given(st.lists(st.tuples(st.floats(0.1, 0.6), st.floats(-0.3, 0.3)), min_size=STEPS, max_size=STEPS))
def test_moves_lead_from_the_footholds_of_any_gaits_to_the_planned_ones(steps: list[tuple[float, float]]) -> None:
    """The turn and the pace of the steps may change after the footholds were planned."""
    preview = preview_on(STAIRS, 0.45, 1.0 + 0.29 * 3 + 0.06 + 0.08j)._replace(command=Command(0.6))
    assert not preview.is_regular
    start = 1.0 + 0.29 * 3 + 0.06 + 0.08j
    gaits = [gait(length, turn) for length, turn in steps]
    place, direction, side = start, 1.0 + 0j, "Left"
    for move, foothold, step in zip(preview.moves(gaits, start, "Left", 1.0), preview.footholds, gaits, strict=True):
        place += step.displacement.on(side) * direction + move  # type: ignore[arg-type]
        assert place == pytest.approx(foothold.position)
        direction, side = direction * cmath.exp(1j * step.turn), "Right" if side == "Left" else "Left"


@given(st.floats(-0.4, 0.4))
def test_steps_over_a_large_rise_or_an_obstacle_take_longer(rise: float) -> None:
    factor = PACING.duration_factor(rise, 0.0)
    assert factor == PACING.duration_factor(-rise, 0.0) >= 1.0
    assert PACING.duration_factor(rise, 0.15) >= max(factor, PACING.duration_factor(0.0, 0.15)) > 1.0
    if abs(rise) <= PACING.free_rise:
        assert factor == 1.0
