"""What the walker knows of the terrain: exact, with errors of a given size, or only what its feet feel."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.quantity import ParameterError
from humanwalk.scenario import parse_scenario
from humanwalk.terrain import Course, Ground, Plane
from humanwalk.terrain.rough import Rough
from humanwalk.walking.knowledge import KNOWLEDGE, BlindKnowledge, ExactKnowledge, NoisyKnowledge

COURSE = Course(pieces=(Rough(length=8.0, height=0.05),))
seeds = st.integers(0, 2**32 - 1)
coordinates = st.floats(-2.0, 6.0)


def known(knowledge: Any, terrain: Ground, seed: int = 0) -> Ground:
    ground: Ground = knowledge.ground(terrain, np.random.default_rng(seed))
    return ground


def test_exact_knowledge_is_the_terrain() -> None:
    assert known(ExactKnowledge(), COURSE) is COURSE
    assert COURSE.felt((), 0.01) is COURSE
    assert COURSE.unseen == 0.0


def test_blind_knowledge_is_level_ground_whatever_the_terrain() -> None:
    ground, xy = known(BlindKnowledge(), COURSE), np.random.default_rng(0).uniform(-2.0, 8.0, (50, 2))
    assert (ground.height(xy) == 0.0).all()
    assert (ground.axes(xy) == np.eye(3)).all()
    assert ground.unseen == BlindKnowledge().unevenness > 0.0


def test_noisy_knowledge_has_errors_of_the_given_size() -> None:
    """Over many seeds at one place; the standard deviation of 2000 samples is within 5 %."""
    xy, noisy = np.array((1.0, 0.5)), NoisyKnowledge(height=0.02, slope=0.03)
    grounds = [known(noisy, Plane(), seed) for seed in range(2000)]
    heights = np.array([ground.height(xy) for ground in grounds])
    gradients = np.array([ground.face_at(xy).gradient for ground in grounds])
    assert heights.std() == pytest.approx(0.02, rel=0.06)
    assert gradients.std(axis=0) == pytest.approx((0.03, 0.03), rel=0.06)
    assert abs(heights.mean()) < 0.002


@given(seeds)
def test_the_same_seed_has_the_same_errors(seed: int) -> None:
    xy = np.array(((0.0, 0.0), (3.0, 1.0)))
    heights = [known(NoisyKnowledge(), COURSE, seed).height(xy) for _ in range(2)]
    assert (heights[0] == heights[1]).all()
    assert (known(NoisyKnowledge(height=0.0), COURSE, seed).height(xy) == COURSE.height(xy)).all()


@given(coordinates, coordinates, seeds)
def test_the_normal_of_a_noisy_ground_is_the_gradient_of_its_height(x: float, y: float, seed: int) -> None:
    ground, h = known(NoisyKnowledge(), Plane(slope=0.1), seed), 1e-5
    xy = np.array((x, y))
    change = [ground.height(xy + d) - ground.height(xy - d) for d in (np.array((h, 0.0)), np.array((0.0, h)))]
    normal = ground.axes(xy)[2]
    np.testing.assert_allclose(normal[:2] / normal[2], -np.array(change) / (2.0 * h), atol=1e-6)


@given(coordinates, coordinates, seeds)
def test_a_face_of_a_noisy_ground_touches_it_and_keeps_its_rectangle(x: float, y: float, seed: int) -> None:
    ground, xy = known(NoisyKnowledge(), COURSE, seed), np.array((x, y))
    face, true = ground.face_at(xy), COURSE.face_at(xy)
    assert (face.lower, face.upper, face.friction) == (true.lower, true.upper, true.friction)
    assert face.height(xy) == pytest.approx(ground.height(xy), abs=1e-9)
    assert len(ground.faces_near(xy, 0.4)) == len(COURSE.faces_near(xy, 0.4))


@pytest.mark.parametrize("tag", KNOWLEDGE)
def test_a_scenario_names_it_by_its_tag(tag: str) -> None:
    controller = parse_scenario(f"controller: {{balanced: {{knowledge: {tag}}}}}").controller
    assert type(controller.knowledge) is KNOWLEDGE[tag]  # type: ignore[attr-defined]


def test_an_error_out_of_range_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"knowledge\.noisy\.height: 2 is out of range; allowed: 0 to 0.2 m"):
        parse_scenario("controller: {balanced: {knowledge: {noisy: {height: 2.0}}}}")
