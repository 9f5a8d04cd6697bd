"""The look `person` follows the body: proportions, girth, sex and age."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from humanwalk.body import Skeleton, human
from humanwalk.body.subject import Subject
from humanwalk.body.visual import Visual, ellipsoid
from humanwalk.body.visuals import visuals

MAN = Subject(70.0, 1.75, "male").body


def part(skeleton: Skeleton, name: str) -> Visual:
    (found,) = [visual for visual in visuals(skeleton) if visual.name == name]
    return found


def test_the_look_fits_the_reference_human() -> None:
    """De Leva's man of the same mass and stature has the limbs of the look; his head is shorter."""
    for visual in visuals(human()):
        if visual.body.endswith(("Femur_Thigh", "Tibia", "UlnaRadius_Forearm")):
            assert part(MAN, visual.name).size == pytest.approx(visual.size, rel=0.05), visual.name


def test_limbs_end_at_their_joints() -> None:
    for subject in (Subject(60.0, 1.65, "female"), Subject(20.0, 1.1, "male", 6.0), Subject(60.0, 1.65)):
        body = subject.body
        for name, joint in (
            ("RightLeg_Femur_Thigh_knee", "RightLegTibiaMotion"),
            ("RightArm_Humor_Upper_Arm_elbow", "RightArmElbowMotion"),
        ):
            assert part(body, name).center == pytest.approx(body.joint(joint).origin, abs=1e-9)


def test_heavy_people_are_thick_and_not_long() -> None:
    heavy = Subject(110.0, 1.75, "male").body
    for name in ("Ribs_chest", "RightLeg_Femur_Thigh_thigh"):
        thin, thick = part(MAN, name), part(heavy, name)
        # Girth goes with the root of mass over length.
        np.testing.assert_allclose(np.divide(thick.size, thin.size)[:2], (110.0 / 70.0) ** 0.5, rtol=1e-6)
        assert thick.size[2] == pytest.approx(thin.size[2], rel=1e-9)
    assert part(heavy, "Head_skull").size == part(MAN, "Head_skull").size


def test_children_have_large_heads() -> None:
    boy, man = Subject(20.0, 1.10, "male", 6.0).body, MAN
    share = [part(body, "Head_skull").size[2] / body.stature for body in (boy, man)]
    assert share[0] > 1.25 * share[1]


def test_women_have_long_hair_and_a_narrow_waist() -> None:
    woman = Subject(60.0, 1.65, "female").body
    assert {v.part for v in visuals(woman)} - {v.part for v in visuals(MAN)} == {"hair_knot", "hair_tail"}
    waist, hips = (part(woman, name).size[1] / part(MAN, name).size[1] for name in ("Lumbar_3_waist", "Pelvis_hips"))
    assert waist < 0.9 * hips


def test_a_rotated_part_grows_along_its_own_axes() -> None:
    """The scaled ellipsoid has the extent of the stretched one along each axis that stays principal."""
    turned = ellipsoid("Ribs", "bar", (0.0, 0.0, 0.0), (0.3, 0.1, 0.1), (0, 0, 0), (0.0, 0.0, np.pi / 2))
    assert turned.scaled((1.0, 2.0, 3.0)).size == pytest.approx((0.6, 0.1, 0.3))
    oblique = ellipsoid("Ribs", "ball", (0.1, 0.2, 0.3), (0.1, 0.1, 0.1), (0, 0, 0), (0.3, -0.4, 0.5))
    grown = oblique.scaled((2.0, 2.0, 2.0))
    assert grown.size == pytest.approx((0.2, 0.2, 0.2))
    assert grown.center == pytest.approx((0.2, 0.4, 0.6))
    R = Rotation.from_euler("xyz", oblique.rpy).as_matrix()
    stretched = np.linalg.norm(np.diag((1.0, 1.5, 2.0)) @ R, axis=0)
    assert oblique.scaled((1.0, 1.5, 2.0)).size == pytest.approx(tuple(0.1 * stretched))
