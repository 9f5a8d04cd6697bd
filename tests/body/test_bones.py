"""The look `bones` shows the geometry of the computed body."""

from typing import Any

import numpy as np
import pytest
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body import REFERENCE_STATURE, human, to_sdf
from humanwalk.body.bones import CONTACT, bones
from humanwalk.body.contact import contact_spheres
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject
from humanwalk.body.visual import Visual
from humanwalk.numerics import Array


@pytest.fixture(scope="module", params=[(70.0, 1.75), (45.0, 1.5)], ids=str)
def skeleton(request: pytest.FixtureRequest) -> Skeleton:
    mass, stature = request.param
    return human().scaled(mass, stature)


def ends(visual: Visual) -> list[Array]:
    """The two ends of a rod's middle line in the body frame."""
    roll, pitch, yaw = visual.rpy
    assert roll == 0.0
    along = np.array([np.sin(pitch) * np.cos(yaw), np.sin(pitch) * np.sin(yaw), np.cos(pitch)])
    return [np.array(visual.center) + half * visual.size[1] * along for half in (-0.5, 0.5)]


def part(skeleton: Skeleton, body: str, name: str) -> list[Visual]:
    return [visual for visual in bones(skeleton) if visual.body == body and visual.part == name]


def test_a_rod_leads_from_every_joint_to_the_next(skeleton: Any) -> None:
    for connection in (*skeleton.joints, *skeleton.welds):
        if np.linalg.norm(connection.origin) < 0.009:
            continue
        (rod,) = part(skeleton, connection.parent, f"rod_{connection.child}")
        found = ends(rod)
        for wanted in (np.zeros(3), np.array(connection.origin)):
            assert min(np.linalg.norm(end - wanted) for end in found) < 1e-9


def test_every_joint_has_its_axis(skeleton: Skeleton) -> None:
    for joint in skeleton.joints:
        (axis,) = part(skeleton, joint.child, "axis")
        begin, end = ends(axis)
        np.testing.assert_allclose(begin, -end, atol=1e-12)
        np.testing.assert_allclose(np.cross(end, joint.axis), 0.0, atol=1e-12)
        assert len(part(skeleton, joint.child, "joint")) == 1


def test_the_contact_points_are_those_that_touch(skeleton: Skeleton) -> None:
    shown = [(v.body, v.center, v.size[0]) for v in bones(skeleton) if v.color == CONTACT]
    assert sorted(shown) == sorted((s.body, s.center, s.radius) for s in contact_spheres(skeleton))


def test_nothing_is_under_the_ground_and_the_head_is_the_highest(skeleton: Skeleton) -> None:
    scale = skeleton.stature / REFERENCE_STATURE
    for visual in bones(skeleton):
        origin = skeleton.origins[visual.body]
        if visual.primitive in ("capsule", "cylinder"):
            lowest = min(end[2] for end in ends(visual)) - visual.size[0]
        else:
            lowest = visual.center[2] - visual.size[-1]
        assert origin[2] + lowest > -0.001 * scale, visual.name
    (skull,) = part(skeleton, "Head", "skull")
    assert skeleton.origins["Head"][2] + skull.center[2] + skull.size[2] == pytest.approx(skeleton.stature)


def test_drake_reads_the_look_strictly_and_only_the_look_differs() -> None:
    plant = MultibodyPlant(time_step=0.0)
    parser = Parser(plant)
    parser.SetStrictParsing()
    parser.AddModelsFromString(to_sdf(human(), "bones"), "sdf")
    plant.Finalize()
    person = kinematics_plant(Subject(sex="unspecified"))
    assert plant.num_positions() == person.num_positions()
    M, M_person = (model.CalcMassMatrix(model.CreateDefaultContext()) for model in (plant, person))
    np.testing.assert_allclose(M, M_person, atol=1e-12)


def test_the_look_changes_neither_mass_nor_stature() -> None:
    assert Subject(look="bones").skeleton == Subject().skeleton
