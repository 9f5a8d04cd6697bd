"""A swing over ground that stands out is lifted, over stairs, curbs, beams and boxes; on a plane it is not changed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.body.contact import SoleExtent
from humanwalk.numerics.scalars import clip, quintic_blend
from humanwalk.terrain import Course, Plane, highest_along
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.steps import Curb, Obstacle, Stairs
from humanwalk.walking.felt_ground import FeltGround
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.swing_clearance import INTERVALS, TIMES, Clearance, ClearanceParameters, OrdinarySwing, clearance

SOLE = SoleExtent(back=0.055, front=0.211, half_width=0.048)
LAW = ClearanceParameters()
LIFT = (*(0.2 * k / INTERVALS for k in range(1, INTERVALS - 1)), 0.05)


def sole_above_ground(course: Course, start: complex, end: complex, progress: float = 0.1, late: float = 0.0) -> float:
    """Least height [m] of a level sole above the ground until nine tenths of its swing.

    At a progress it is late by a share of its way, which it makes up for until it arrives.
    """
    feet = Foothold.on(course, start), Foothold.on(course, end)
    now = progress, start + (quintic_blend(progress)[0] - late) * (end - start)
    added = clearance(course, *feet, 0.0, SOLE, LAW, OrdinarySwing(now=now if late else None))
    least = np.inf
    for s in np.linspace(progress, 0.9, 25):
        share = quintic_blend(clip((s - added.depart) / (added.arrive - added.depart), 0.0, 1.0))[0]
        behind = late * clip((added.arrive - s) / (added.arrive - progress), 0.0, 1.0)
        ankle = start + (share - behind) * (end - start)
        height = feet[0].ground + quintic_blend(s)[0] * (feet[1].ground - feet[0].ground) + added.at(s).value
        path = np.array([(ankle.real + x, ankle.imag) for x in (-SOLE.back, SOLE.front)])
        least = min(least, height - highest_along(course, path, 1e-6))
    return least


@given(st.floats(-0.17, 0.17), st.floats(-0.1, 0.1), st.floats(0.1, 0.9))
def test_on_a_plane_nothing_is_added(slope: float, cross_slope: float, length: float) -> None:
    plane = Plane(slope=slope, cross_slope=cross_slope)
    feet = Foothold.on(plane, 0.1j), Foothold.on(plane, length + 0.1j)
    assert clearance(plane, *feet, 0.0, SOLE, LAW) == Clearance()


STAIRS = {direction: Course(pieces=(Stairs(rise=0.185, tread=0.28, direction=direction, number=9),), run_up=0.5)
          for direction in ("up", "down")}  # fmt: skip


@pytest.mark.parametrize("direction", ["up", "down"])
def test_two_treads_of_stairs_are_cleared(direction: str) -> None:
    ankle = 0.5 + 0.28 * 2 + 0.062
    assert sole_above_ground(STAIRS[direction], complex(ankle), complex(ankle + 0.56)) > 0.0


@pytest.mark.parametrize("late", [0.0, 0.2, 0.3])
@pytest.mark.parametrize("beyond", [0.1, 0.2])
def test_a_foot_that_is_late_passes_the_last_edges_of_stairs(late: float, beyond: float) -> None:
    ankle, bottom = 0.5 + 0.28 * 7 + 0.062, 0.5 + 0.28 * 9 + beyond
    assert sole_above_ground(STAIRS["down"], complex(ankle), complex(bottom), 0.5, late) > 0.0


def test_beside_a_riser_the_foot_rises_first_and_below_an_edge_it_sinks_last() -> None:
    ankle = 0.5 + 0.28 * 2 + 0.062
    for direction, departs, arrives in (("up", LAW.rising, 1.0), ("down", 0.0, 1.0 - LAW.sinking_part(-2.0 * 0.185))):
        course = STAIRS[direction]
        feet = Foothold.on(course, complex(ankle)), Foothold.on(course, complex(ankle + 0.56))
        added = clearance(course, *feet, 0.0, SOLE, LAW)
        assert (added.depart, added.arrive) == (departs, arrives)


def test_a_foot_that_rises_first_or_sinks_last_does_so_in_the_whole_swing() -> None:
    """At the limit of nearness both change with every small motion of the foothold."""
    begun = Clearance((0.0,) * len(LIFT), depart=LAW.rising, arrive=1.0 - LAW.sinking)
    later = begun.filtered(Clearance(LIFT), 0.25)
    assert (later.depart, later.arrive) == (begun.depart, begun.arrive)
    assert later.lift == pytest.approx([0.25 * height for height in LIFT])
    assert Clearance().filtered(begun, 0.25)[1:] == begun[1:]


@given(st.floats(0.0, 0.3), st.floats(0.0, 0.3))
def test_a_foot_sinks_for_longer_the_deeper_the_step_down_is(rise: float, farther: float) -> None:
    assert LAW.sinking_part(rise) == LAW.sinking <= LAW.sinking_part(-rise) <= LAW.sinking_part(-rise - farther)


@settings(max_examples=20)
@given(st.floats(0.02, 0.25), st.floats(0.25, 0.7))
def test_a_beam_between_the_footholds_is_cleared_by_the_margin(height: float, before: float) -> None:
    course = Course(pieces=(Obstacle(height=height),), run_up=0.5)
    start = complex(1.45 - before)
    end = complex(1.55 + SOLE.back + 0.05)
    assert sole_above_ground(course, start, end) > -1e-9
    feet = Foothold.on(course, start), Foothold.on(course, end)
    assert max(clearance(course, *feet, 0.0, SOLE, LAW).lift) == pytest.approx(height + LAW.margin, abs=0.01)


@settings(max_examples=20)
@given(st.floats(0.02, 0.2), st.sampled_from(["up", "down"]))
def test_a_curb_is_cleared(height: float, direction: str) -> None:
    course = Course(pieces=(Curb(height=height, direction=direction),), run_up=0.5)  # type: ignore[arg-type]
    assert sole_above_ground(course, complex(0.2), complex(0.75)) > -LAW.tolerance


@settings(max_examples=20)
@given(st.integers(0, 1000))
def test_boxes_under_the_way_are_cleared(seed: int) -> None:
    course = Course(pieces=(Rough(length=4.0, height=0.05, seed=seed),), run_up=0.5)
    assert sole_above_ground(course, 1.062 + 0.1j, 1.862 + 0.1j) > -LAW.tolerance


@settings(max_examples=20)
@given(st.floats(0.0, 0.08), st.floats(0.3, 0.7))
def test_toes_that_would_pass_below_the_plane_between_two_faces_are_lifted_to_it(depth: float, middle: float) -> None:
    course = Course(pieces=(Rough(length=4.0, height=0.002),), run_up=0.5)
    feet = Foothold.on(course, 1.062 + 0.1j), Foothold.on(course, 1.862 + 0.1j)
    ordinary = 0.01 - depth * np.exp(-(((TIMES - middle) / 0.1) ** 2))
    added = clearance(course, *feet, 0.0, SOLE, LAW, OrdinarySwing(ordinary))
    inner = (TIMES >= 0.2) & (TIMES <= 0.8)
    lowest = ordinary + [added.at(float(progress)).value for progress in TIMES]
    assert lowest[inner].min() >= -1e-3


def test_the_lift_has_rates_that_are_derivatives_and_rests_at_both_ends() -> None:
    added, h = Clearance(LIFT), 1e-6
    for progress in (0.1, 0.3, 0.6, 0.9):
        before, here, after = (added.at(progress + d) for d in (-h, 0.0, h))
        assert (after.value - before.value) / (2 * h) == pytest.approx(here.rate, abs=1e-5)
        assert (after.rate - before.rate) / (2 * h) == pytest.approx(here.acceleration, abs=1e-4)
    for end in (0.0, 1.0):
        assert added.at(end)[:2] == pytest.approx((0.0, 0.0), abs=1e-12)
    assert [added.at(k / INTERVALS).value for k in range(1, INTERVALS)] == pytest.approx(LIFT)


@given(st.floats(0.0, 0.1))
def test_ground_that_may_stand_out_unseen_lifts_the_foot_on_its_way_and_not_at_its_ends(unseen: float) -> None:
    ground = FeltGround(Plane(), unevenness=unseen)
    feet = Foothold.on(ground, 0.1j), Foothold.on(ground, 0.6 + 0.1j)
    added = clearance(ground, *feet, 0.0, SOLE, LAW)
    assert added.at(0.5).value == pytest.approx(unseen)
    assert (added.at(0.0).value, added.at(1.0).value) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert all(0.0 <= lift <= unseen + 1e-12 for lift in added.lift)
