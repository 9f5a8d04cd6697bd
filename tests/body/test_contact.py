"""The sole that the asperity law acts on."""

import numpy as np
import pytest

from humanwalk.body import SIDES, contact_spheres, sole_patches
from humanwalk.body.contact import rectangle_patch
from humanwalk.body.skeleton import Skeleton


@pytest.mark.parametrize("grid", [(2, 2), (3, 2), (5, 4)])
def test_the_area_of_a_face_is_divided_among_points_up_to_its_rim(grid: tuple[int, int]) -> None:
    patch = rectangle_patch("sole", (0.1, 0.2, 0.3), (0.4, 0.3), grid)
    assert patch.p_BoQ_B.shape == (grid[0] * grid[1], 3)
    np.testing.assert_allclose(patch.p_BoQ_B.min(axis=0), [-0.1, 0.05, 0.3])
    np.testing.assert_allclose(patch.p_BoQ_B.max(axis=0), [0.3, 0.35, 0.3])
    assert patch.area.sum() == pytest.approx(0.4 * 0.3)
    np.testing.assert_allclose(patch.area @ patch.p_BoQ_B / patch.area.sum(), [0.1, 0.2, 0.3])
    # A corner has a rectangle of half the spacing along each side.
    corner = 0.4 * 0.3 / (4 * (grid[0] - 1) * (grid[1] - 1))
    assert patch.area.min() == pytest.approx(corner)


def test_the_spheres_of_a_foot_stand_within_its_flat_sole(skeleton: Skeleton) -> None:
    """All contact models offer nearly the same support."""
    patches = {patch.body: patch for side in SIDES for patch in sole_patches(skeleton, side)}
    spheres = contact_spheres(skeleton)
    assert {sphere.body for sphere in spheres} == set(patches)
    for sphere in spheres:
        corners = patches[sphere.body].p_BoQ_B
        assert patches[sphere.body].area.sum() == pytest.approx(np.prod(np.ptp(corners[:, :2], axis=0)))
        np.testing.assert_allclose(corners[:, 2], sphere.center[2] - sphere.radius, atol=1e-12)
        assert np.all(corners[:, :2].min(axis=0) < sphere.center[:2])
        assert np.all(sphere.center[:2] < corners[:, :2].max(axis=0))
