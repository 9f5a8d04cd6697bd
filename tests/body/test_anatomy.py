"""The reference human against the thesis' tables and the body table derived from them."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.body import Joint, Skeleton, human
from humanwalk.body.limbs import LEGS
from humanwalk.body.skeleton import Segment

TABLE = json.loads((Path(__file__).parents[1] / "data" / "body_table.json").read_text())
ROWS = {row["name"]: row for row in TABLE["bodies"]}
REVOLUTE_ROWS = [row for row in TABLE["bodies"] if row["type"] == "revolute"]

# Thesis Tables 3.1 and 3.2: moments about the x, y, z axis in 1e-4 kg m2, as printed. A prism's
# height is z, depth x, width y. `None` marks an entry that an erratum corrects.
PRINTED_MOMENTS = {
    "RightLeg_FootToes": ("2.38", "1.07", "2.94"),
    "RightLeg_FootMiddle": ("4.47", "4.09", "5.79"),
    "RightArm_Hand": ("3.65", "5.17", "2.63"),
    "Pelvis": ("938.85", "470.99", "844.57"),  # holds only with the depth of erratum E2
    "RightLeg_Ankle": ("2.30073", None, None),  # E3, E4
    "RightLeg_Ankle_Part1": (None, "0.816", None),  # E3
    "RightLeg_Ankle_Part2": ("0.816", None, None),  # E3
    "RightLeg_Tibia": (None, None, "46.0578"),  # E3
    "RightLeg_Femur_Thigh": (None, None, "204.30484"),  # E3
    "RightArm_Humor_Upper_Arm": (None, None, "27.95499"),  # E3
    "RightArm_UlnaRadius_Forearm": (None, None, "12.95569"),  # E3
    "Ribs": (None, None, "1620.0"),  # E3, E4
}
# What erratum E3 puts in place of the printed thin-rod moments, 1e-4 kg m2.
CORRECTED_TRANSVERSE = {
    "RightLeg_Femur_Thigh": "1576.06",
    "RightLeg_Tibia": "519.41",
    "RightArm_Humor_Upper_Arm": "243.57",
    "RightArm_UlnaRadius_Forearm": "96.23",
    "RightLeg_Ankle_Part2": "0.831",
    "RightLeg_Ankle": "3.869",
    "Ribs": "1560.0",
}


@pytest.fixture(scope="module")
def body() -> Skeleton:
    return human()


def half_last_digit(printed: str) -> float:
    return 0.5 * 10.0 ** -len(printed.partition(".")[2])


def test_bodies_are_the_tables_in_its_order(body: Skeleton) -> None:
    assert [s.name for s in body.segments] == list(ROWS)
    assert len(body.segments) == 44
    assert len(body.joints) == 42
    assert [(w.parent, w.child) for w in body.welds] == [("Thoracic_7_9", "Ribs")]


def test_joints_are_the_tables_in_its_order(body: Skeleton) -> None:
    # A back joint has its body's name in the table; SDFormat wants two names for two things.
    expected = [row["joint"].partition(" (")[0] for row in REVOLUTE_ROWS]
    expected = [f"{name}_Motion" if name in ROWS else name for name in expected]
    assert [j.name for j in body.joints] == expected


@pytest.mark.parametrize("row", TABLE["bodies"], ids=lambda row: row["name"])
def test_segment_and_its_place_equal_the_table(body: Any, row: Any) -> None:
    segment = body.segment(row["name"])
    inboard = body.inboard(row["name"])
    assert segment.mass == pytest.approx(row["mass_kg"], abs=1e-12)
    np.testing.assert_allclose(segment.com, row["com_in_body_m"], atol=1e-12)
    np.testing.assert_allclose(segment.inertia, row["inertia_com_kgm2"], rtol=5e-6)
    # The table rounds a place and the steps that lead to it apart, each to a micrometer.
    np.testing.assert_allclose(body.origins[segment.name], row["neutral_origin_world_m"], atol=1.1e-6)
    assert (inboard and inboard.parent) == row["parent"]
    if inboard is not None:
        np.testing.assert_allclose(inboard.origin, row["joint_origin_in_parent_m"], atol=1e-12)


@pytest.mark.parametrize("row", REVOLUTE_ROWS, ids=lambda row: row["name"])
def test_joint_equals_the_table(body: Any, row: Any) -> None:
    joint = body.inboard(row["name"])
    assert isinstance(joint, Joint)
    assert joint.axis == tuple(row["axis"])
    # The one range that is not the table's: a loaded ankle bends further than the unloaded one that AAOS measures.
    expected = [-50, 35] if joint.motion == "ankle dorsiflexion" else row["rom_deg"]
    np.testing.assert_allclose(np.rad2deg(joint.range_rad), expected, atol=0.005)


@pytest.mark.parametrize("name", PRINTED_MOMENTS)
def test_moments_equal_the_thesis_to_the_printed_digits(body: Skeleton, name: str) -> None:
    for moment, printed in zip(body.segment(name).inertia, PRINTED_MOMENTS[name], strict=True):
        if printed is not None:
            assert moment * 1e4 == pytest.approx(float(printed), abs=half_last_digit(printed))


@pytest.mark.parametrize("name", CORRECTED_TRANSVERSE)
def test_cylinders_are_solid_and_not_thin_rods(body: Skeleton, name: str) -> None:
    printed = CORRECTED_TRANSVERSE[name]
    moments = body.segment(name).inertia * 1e4
    assert moments[1] == pytest.approx(float(printed), abs=half_last_digit(printed))
    assert moments.max() >= moments[1]


def test_totals_and_heights(body: Skeleton) -> None:
    assert body.total_mass == pytest.approx(70.0, abs=1e-9)
    assert body.stature == pytest.approx(1.75, abs=1e-9)
    assert body.hip_height == pytest.approx(0.931967, abs=1e-12)
    assert body.ankle_height("Right") == pytest.approx(0.068, abs=1e-12)
    assert body.leg_length == pytest.approx(0.4242 + 0.439767, abs=1e-12)
    assert body.hip_half_width == pytest.approx(0.0875, abs=1e-12)


def test_whole_body_mass_properties(body: Skeleton) -> None:
    np.testing.assert_allclose(body.com, TABLE["com"], atol=1e-8)
    inertia = np.zeros((3, 3))
    for segment in body.segments:
        r = body.origins[segment.name] + segment.com - body.com
        inertia += np.diag(segment.inertia) + segment.mass * (r @ r * np.eye(3) - np.outer(r, r))
    np.testing.assert_allclose(np.diag(inertia), TABLE["inertia_com"], rtol=1e-6)
    # Measured men of this size: center of mass at .55 to .56 of stature (check table).
    assert 0.55 <= body.com[2] / body.stature <= 0.565


def test_every_body_satisfies_the_strict_triangle_inequality(body: Skeleton) -> None:
    for segment in body.segments:
        moments = np.sort(segment.inertia)
        assert moments[0] > 0.0, segment.name
        assert moments[2] < moments[0] + moments[1], segment.name


def test_neutral_standing_is_within_every_range(body: Skeleton) -> None:
    for joint in body.joints:
        low, high = joint.range_rad
        assert low <= 0.0 <= high, joint.name
        assert low < high, joint.name


def test_back_ranges_add_up_to_the_thoracolumbar_ranges(body: Skeleton) -> None:
    back = [j for j in body.joints if j.child.startswith(("Lumbar", "Thoracic"))]
    assert len(back) == 10
    totals = {
        axis: np.rad2deg(np.sum([j.range_rad for j in back if j.axis == axis], axis=0))
        for axis in ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    }
    np.testing.assert_allclose(totals[0.0, 1.0, 0.0], (-25.0, 80.0))
    np.testing.assert_allclose(totals[1.0, 0.0, 0.0], (-35.0, 35.0))
    np.testing.assert_allclose(totals[0.0, 0.0, 1.0], (-45.0, 45.0))


def rotation(axis: tuple[float, float, float], angle: float) -> np.ndarray:
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def test_left_is_the_mirror_image_of_right(body: Skeleton) -> None:
    mirror = np.diag([1.0, -1.0, 1.0])
    rights = [s for s in body.segments if s.name.startswith("Right")]
    assert len(rights) == 14
    for right in rights:
        left = body.segment(right.name.replace("Right", "Left"))
        assert (left.mass, left.shape) == (right.mass, right.shape)
        np.testing.assert_allclose(left.com, mirror @ right.com, atol=1e-12)
        np.testing.assert_allclose(body.origins[left.name], mirror @ body.origins[right.name], atol=1e-12)
        right_joint, left_joint = body.inboard(right.name), body.inboard(left.name)
        assert isinstance(right_joint, Joint)
        assert isinstance(left_joint, Joint)
        assert left_joint.name == right_joint.name.replace("Right", "Left")
        assert left_joint.range_rad == right_joint.range_rad
        assert left_joint.effort_limit_N_m == right_joint.effort_limit_N_m
        # The same angle on the left gives the mirror image of the motion on the right.
        np.testing.assert_allclose(
            rotation(left_joint.axis, 0.3),
            mirror @ rotation(right_joint.axis, 0.3) @ mirror,
            atol=1e-12,
        )


def test_positive_angles_are_the_named_motions(body: Skeleton) -> None:
    def moved(joint: str, point: tuple[float, float, float]) -> np.ndarray:
        """Where a small positive angle moves a point of the child body."""
        return rotation(body.joint(joint).axis, 0.1) @ point - point

    below, ahead, above = (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    assert moved("RightLegFemurMotion", below)[0] > 0  # flexion: thigh forward
    assert moved("RightLegFemurSideMotion", below)[1] < 0  # abduction: outward
    assert moved("RightLegFemurTwistMotion", ahead)[1] > 0  # internal rotation: toes inward
    assert moved("RightLegTibiaMotion", below)[0] < 0  # flexion: shank backward
    assert moved("RightLegAnkleMotion", ahead)[2] > 0  # dorsiflexion: toes up
    assert moved("RightLegAnkleRollMotion", below)[1] > 0  # inversion: sole turns inward
    assert moved("RightLegAnkleTwistMotion", ahead)[1] > 0  # toe-in
    assert moved("RightLegFootToesMotion", ahead)[2] > 0  # extension: toes up
    assert moved("RightArmShoulderMotion", below)[0] > 0
    assert moved("RightArmShoulderSideMotion", below)[1] < 0
    assert moved("RightArmElbowMotion", below)[0] > 0
    assert moved("RightArmWristMotion", below)[1] > 0  # palm faces the thigh
    assert moved("Lumbar_6_Motion", above)[0] > 0
    assert moved("Lumbar_5_Motion", above)[1] < 0
    assert moved("Head_Motion", ahead)[1] > 0


@pytest.mark.parametrize("side", ["Right", "Left"])
def test_leg_joints_are_the_chain_from_hip_to_hind_foot(body: Any, side: Any) -> None:
    chain = [body.joint(name) for name in LEGS[side].chain]
    assert chain[0].parent == "Pelvis"
    assert chain[-1].child == f"{side}Leg_Ankle"
    assert [j.parent for j in chain[1:]] == [j.child for j in chain[:-1]]
    assert len(chain) == 7


def test_every_joint_has_sources_of_its_numbers(body: Skeleton) -> None:
    for joint in body.joints:
        assert joint.motion
        assert joint.range_source
        assert joint.effort_source
        assert joint.effort_limit_N_m > 0
        assert joint.rotor_inertia > 0
        assert joint.damping > 0
    assert all(segment.source for segment in body.segments)


def test_segments_out_of_order_are_refused(body: Skeleton) -> None:
    with pytest.raises(ValueError, match="segments: 'RightLeg_HipPart2' must come once"):
        Skeleton(
            segments=(body.segments[0], body.segments[2], body.segments[1]),
            joints=body.joints,
            welds=body.welds,
            root_height=body.root_height,
        )


def test_a_segment_without_an_inboard_joint_is_refused(body: Skeleton) -> None:
    stray = Segment("Hat", body.segments[0].shape, 0.1, (0.0, 0.0, 0.0), "nowhere")
    with pytest.raises(ValueError, match="segments: 'Hat'"):
        Skeleton((*body.segments, stray), body.joints, body.welds, body.root_height)
