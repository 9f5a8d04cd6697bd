"""The sole that the asperity law acts on."""

import numpy as np
import pytest

from humanwalk.body import SIDES, contact_boxes, sole_patches
from humanwalk.body.contact import rectangle_patch
from humanwalk.body.skeleton import Skeleton


@pytest.mark.parametrize("grid", [(2, 2), (3, 2), (5, 4)])
def test_the_area_of_a_face_is_divided_among_points_up_to_its_rim(grid: tuple[int, int]) -> None:
    patch = rectangle_patch("box", (0.1, 0.2, 0.3), (0.4, 0.3, 0.2), grid)
    assert patch.p_BoQ_B.shape == (grid[0] * grid[1], 3)
    np.testing.assert_allclose(patch.p_BoQ_B.min(axis=0), [-0.1, 0.05, 0.2])
    np.testing.assert_allclose(patch.p_BoQ_B.max(axis=0), [0.3, 0.35, 0.2])
    assert patch.area.sum() == pytest.approx(0.4 * 0.3)
    np.testing.assert_allclose(patch.area @ patch.p_BoQ_B / patch.area.sum(), [0.1, 0.2, 0.2])
    # A corner has a rectangle of half the spacing along each side.
    corner = 0.4 * 0.3 / (4 * (grid[0] - 1) * (grid[1] - 1))
    assert patch.area.min() == pytest.approx(corner)


def test_patches_are_the_lower_faces_of_the_boxes(skeleton: Skeleton) -> None:
    boxes = {box.body: box for box in contact_boxes(skeleton)}
    patches = [patch for side in SIDES for patch in sole_patches(skeleton, side)]
    assert {patch.body for patch in patches} == set(boxes)
    for patch in patches:
        box = boxes[patch.body]
        np.testing.assert_allclose(patch.p_BoQ_B[:, 2], box.center[2] - 0.5 * box.size[2])
        assert patch.area.sum() == pytest.approx(box.size[0] * box.size[1])
