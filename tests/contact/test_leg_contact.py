"""The legs collide with each other, and their capsules with nothing else."""

from typing import Any

import numpy as np
import pytest
from pydrake.geometry import Role
from pydrake.systems.framework import Diagram

from humanwalk.body.limbs import LEGS
from humanwalk.body.skeleton import Skeleton
from humanwalk.contact.leg_contact import LEG_SET
from humanwalk.diagrams.walker import make_diagram
from humanwalk.scenario import load_scenario
from humanwalk.sides import SIDES

CROSSED = {leg.hip_abduction: -0.2 for leg in LEGS.values()}
"""Adduction of both hips [rad]."""

SIDE_OF = {body: side for side, leg in LEGS.items() for body in (leg.thigh, leg.shank, leg.hindfoot)}
"""Bodies with capsules."""


def pairs(diagram: Diagram, **angles: Any) -> set[frozenset[str]] | set[Any]:
    """The bodies that touch each other in a posture, without the ground."""
    plant = diagram.GetSubsystemByName("plant")
    context = diagram.CreateDefaultContext()
    for name, angle in angles.items():
        plant.GetJointByName(name).set_angle(plant.GetMyMutableContextFromRoot(context), angle)
    query = diagram.GetOutputPort("query_object").Eval(context)
    found = set()
    for touch in query.ComputePointPairPenetration():
        frames = (query.inspector().GetFrameId(shape) for shape in (touch.id_A, touch.id_B))
        found.add(frozenset(plant.GetBodyFromFrameId(frame).name() for frame in frames))
    return {pair for pair in found if not any(name.lower().startswith("world") for name in pair)}


def walker(**overrides: Any) -> Diagram:
    return make_diagram(load_scenario("stand", overrides))


@pytest.fixture(scope="module")
def diagram() -> Diagram:
    return walker()


def test_standing_legs_do_not_touch(diagram: Diagram) -> None:
    assert pairs(diagram) == set()


def test_legs_that_cross_touch(diagram: Diagram) -> None:
    crossed = pairs(diagram, **CROSSED)
    assert crossed
    assert all({SIDE_OF[body] for body in pair} == {"Right", "Left"} for pair in crossed)


def test_capsules_of_thighs_and_shanks_reach_from_joint_to_joint(diagram: Diagram, skeleton: Skeleton) -> None:
    plant, inspector = diagram.GetSubsystemByName("plant"), diagram.GetSubsystemByName("scene_graph").model_inspector()
    for leg in LEGS.values():
        for body, after in ((leg.thigh, leg.shank), (leg.shank, leg.hindfoot)):
            shapes = plant.GetCollisionGeometriesForBody(plant.GetBodyByName(body))
            (capsule,) = [shape for shape in shapes if inspector.GetName(shape).endswith(LEG_SET)]
            shape, X_BG = inspector.GetShape(capsule), inspector.GetPoseInFrame(capsule)
            ends = [X_BG @ (0.0, 0.0, z * (0.5 * shape.length() + shape.radius())) for z in (-1.0, 1.0)]
            joints = [np.zeros(3), skeleton.origins[after] - skeleton.origins[body]]
            np.testing.assert_allclose(sorted(ends, key=lambda p: -p[2]), joints, atol=1e-9)


def test_a_bent_leg_does_not_touch_itself(diagram: Diagram) -> None:
    assert pairs(diagram, **{LEGS["Right"].knee: 2.2, LEGS["Right"].hip_flexion: 1.2}) == set()


@pytest.mark.parametrize("contact", ["point", "hydroelastic"])
@pytest.mark.parametrize("adduction", np.linspace(0.08, 0.2, 5))
def test_without_leg_contact_the_legs_pass_through_each_other(contact: str, adduction: float) -> None:
    ghost = walker(**{f"contact.{contact}.leg_contact": "false"})
    assert pairs(ghost, **dict.fromkeys(CROSSED, -adduction)) == set()


@pytest.mark.parametrize("contact", ["point", "hydroelastic"])
def test_the_shapes_under_one_foot_do_not_collide_with_those_of_the_other(contact: str) -> None:
    inspector = walker(contact=contact).GetSubsystemByName("scene_graph").model_inspector()
    shapes = [
        shape for shape in inspector.GetAllGeometryIds(Role.kProximity) if LEG_SET not in inspector.GetName(shape)
    ]
    right, left = ([s for s in shapes if inspector.GetName(s).split("::")[-1].startswith(side)] for side in SIDES)
    assert right
    assert all(inspector.CollisionFiltered(a, b) for a in right for b in left)
