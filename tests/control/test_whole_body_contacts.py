"""Contacts of the whole-body program: edges of friction pyramids, and where the cheapest force points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import SIDES, contact_spheres
from humanwalk.body.limbs import LEGS
from humanwalk.body.skeleton import Skeleton
from humanwalk.control.whole_body_contacts import MAX_LEAN, Soles, friction_edges, leaning_edges

UNIT = 1000.0

coefficients = st.floats(0.05, 1.0)
slopes = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))


@given(coefficients, slopes)
def test_the_cheapest_force_leans_by_the_slope_within_a_share_of_the_friction(
    mu: float, slope: tuple[float, float]
) -> None:
    edges = leaning_edges(np.array([mu]), UNIT, np.array([slope]))[0]
    # Least squares of the coefficients for a given third component: in proportion to the edges' third components.
    force = edges[:, 2] @ edges
    assert force[:2] / force[2] == pytest.approx(np.clip(slope, -MAX_LEAN * mu, MAX_LEAN * mu))


@given(coefficients, slopes)
def test_leaning_edges_have_the_directions_of_the_friction_pyramid(mu: float, slope: tuple[float, float]) -> None:
    upright = friction_edges(np.array([mu]), UNIT)[0]
    leaning = leaning_edges(np.array([mu]), UNIT, np.array([slope]))[0]
    assert leaning / leaning[:, 2:] == pytest.approx(upright / upright[:, 2:])
    assert (leaning[:, 2] > 0.0).all()


def test_edges_without_a_slope_are_those_of_the_friction_pyramid() -> None:
    mu = np.array([0.3, 0.7])
    assert (leaning_edges(mu, UNIT, np.zeros((2, 2))) == friction_edges(mu, UNIT)).all()


def test_heels_and_toes_are_in_the_middle_of_their_contact_points(skeleton: Skeleton) -> None:
    spheres = contact_spheres(skeleton)
    bodies = [name for side in SIDES for name in LEGS[side].foot_bodies]
    soles = Soles.of(spheres, bodies)
    ends = [LEGS[side].hindfoot for side in SIDES] + [LEGS[side].toe_segment for side in SIDES]
    assert [bodies[i] for i in soles.body[-4:]] == ends
    for end, p_BP in zip(ends, soles.p_BP[-4:], strict=True):
        under = [sphere for sphere in spheres if sphere.body == end]
        assert p_BP[:2] == pytest.approx(np.mean([sphere.center[:2] for sphere in under], axis=0))
        assert p_BP[2] == pytest.approx(under[0].center[2] - under[0].radius)
