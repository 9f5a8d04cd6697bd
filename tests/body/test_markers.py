"""The marker set: names, bodies, symmetry, and scaling with the body."""

from typing import Any

import numpy as np
import pytest

from humanwalk.body import human
from humanwalk.body.markers import markers
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.body.visuals import visuals
from humanwalk.numerics import Array

PLUG_IN_GAIT = {
    *(f"{side}{name}" for side in "RL" for name in ("FHD", "BHD", "SHO", "UPA", "ELB", "FRM", "WRA", "WRB", "FIN")),
    *(f"{side}{name}" for side in "RL" for name in ("ASI", "PSI", "THI", "KNE", "TIB", "ANK", "HEE", "TOE")),
    *("C7", "T10", "CLAV", "STRN", "RBAK"),
}


def standing(skeleton: Skeleton) -> dict[str, Array]:
    """Where every marker is in neutral standing [m]."""
    return {m.name: skeleton.origins[m.body] + np.array(m.position) for m in markers(skeleton)}


def test_plug_in_gait_is_complete_and_the_other_markers_are_at_joints_and_toes(skeleton: Skeleton) -> None:
    others = {f"{side}{name}" for side in "RL" for name in ("ELM", "KNM", "ANM", "MT1", "MT5", "TIP")}
    assert {m.name for m in markers(skeleton)} - others == PLUG_IN_GAIT
    assert {m.name for m in markers(skeleton)} >= others
    assert len(PLUG_IN_GAIT) == 39


def test_names_are_unique_and_bodies_exist(skeleton: Skeleton) -> None:
    names = [m.name for m in markers(skeleton)]
    assert len(names) == len(set(names))
    assert {m.body for m in markers(skeleton)} <= {s.name for s in skeleton.segments}


def test_sides_mirror_each_other(skeleton: Skeleton) -> None:
    places = standing(skeleton)
    for name, place in places.items():
        twin = places.get(f"L{name[1:]}") if name.startswith("R") and name != "RBAK" else None
        if twin is not None:
            np.testing.assert_allclose(twin, place * [1, -1, 1], atol=1e-12)
    assert all(places[name][1] < 0 for name in places if name.startswith("R"))


@pytest.mark.parametrize(("mass", "stature"), [(55.0, 1.6), (95.0, 2.0), (70.0, 1.75)])
def test_markers_scale_with_the_body(mass: float, stature: float) -> None:
    scaled = standing(Subject(mass, stature, "unspecified").skeleton)
    for name, place in standing(human()).items():
        np.testing.assert_allclose(scaled[name], place * stature / 1.75, atol=1e-9)


def test_positions_of_landmarks_are_anatomical(skeleton: Skeleton) -> None:
    p = standing(skeleton)
    assert p["RFHD"][2] > p["C7"][2] > p["CLAV"][2] > p["STRN"][2] > p["RASI"][2] > p["RKNE"][2] > p["RANK"][2]
    assert p["RASI"][0] > 0 > p["RPSI"][0]
    assert p["RTIP"][0] > p["RTOE"][0] > p["RANK"][0] > p["RHEE"][0]
    assert abs(p["RKNE"][1]) > skeleton.hip_half_width > abs(p["RKNM"][1])


def test_middle_of_medial_and_lateral_marker_is_the_joint_center(skeleton: Skeleton) -> None:
    p = standing(skeleton)
    for lateral, medial, child in (
        ("RKNE", "RKNM", "RightLeg_Tibia"),
        ("LANK", "LANM", "LeftLeg_Ankle_Part1"),
        ("RELB", "RELM", "RightArm_UlnaRadius_Forearm"),
    ):
        np.testing.assert_allclose((p[lateral] + p[medial]) / 2, skeleton.origins[child], atol=1e-12)


def test_markers_are_near_the_skin(skeleton: Any) -> None:
    """Within 2 cm of the surface of the nearest visible part of their own or a neighbouring body."""
    surfaces = []
    for visual in visuals(skeleton):
        if visual.primitive == "ellipsoid" and visual.rpy == (0, 0, 0):
            surfaces.append((skeleton.origins[visual.body] + np.array(visual.center), np.array(visual.size)))  # type: ignore[unreachable]
        elif visual.primitive == "capsule":
            surfaces.append((skeleton.origins[visual.body] + np.array(visual.center), np.array(visual.size[:1] * 3)))
    for name, place in standing(skeleton).items():
        # Distance to an ellipsoid's surface along the ray from its center.
        nearest = min(
            abs(1 - 1 / max(1e-9, np.linalg.norm((place - center) / radii))) * np.linalg.norm(place - center)
            for center, radii in surfaces
        )
        assert nearest < 0.02, name
