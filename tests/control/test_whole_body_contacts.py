"""Contacts of the whole-body program: edges of friction pyramids, and the middles of heels and toes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import SIDES, contact_spheres
from humanwalk.body.limbs import LEGS
from humanwalk.body.skeleton import Skeleton
from humanwalk.control.whole_body_contacts import Soles, friction_edges

UNIT = 1000.0


@given(st.floats(0.05, 1.0))
def test_edges_are_those_of_a_friction_pyramid(mu: float) -> None:
    edges = friction_edges(np.array([mu]), UNIT)[0]
    assert edges[:, 2] == pytest.approx(UNIT)
    assert np.hypot(edges[:, 0], edges[:, 1]) == pytest.approx(mu * UNIT)
    assert edges.sum(axis=0)[:2] == pytest.approx([0.0, 0.0])


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
