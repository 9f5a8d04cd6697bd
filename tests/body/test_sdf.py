"""The model file as Drake reads it."""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydrake.geometry import Role, SceneGraph, Sphere
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, MultibodyPlant
from pydrake.multibody.tree import RevoluteJoint
from pydrake.systems.framework import DiagramBuilder

import humanwalk
from humanwalk.body import SIDES, SOLE_SET, Skeleton, human, to_sdf
from humanwalk.body.subject import Subject

COMMITTED = Path(humanwalk.__file__).parent / "models" / "sdf" / "human.sdf"
PEOPLE = {
    "reference": human(),
    "small": human().scaled(mass=30.0, stature=1.3),
    "giant": human().scaled(mass=150.0, stature=2.1),
    "woman": Subject(60.0, 1.65, "female").skeleton,
    "heavy man": Subject(130.0, 1.75, "male").skeleton,
    "boy": Subject(20.0, 1.10, "male", 6.0).skeleton,
}


class Parsed:
    """A skeleton's model in a plant of its own, at the default (neutral standing) pose."""

    def __init__(self, skeleton: Skeleton) -> None:
        builder = DiagramBuilder()
        self.skeleton = skeleton
        self.plant: MultibodyPlant
        self.scene_graph: SceneGraph
        self.plant, self.scene_graph = AddMultibodyPlantSceneGraph(builder, time_step=1e-3)
        parser = Parser(self.plant)
        parser.SetStrictParsing()  # turns every warning into an error
        (self.instance,) = parser.AddModelsFromString(to_sdf(skeleton), "sdf")
        self.plant.Finalize()
        self.diagram = builder.Build()
        self.context = self.plant.CreateDefaultContext()

    def shapes(self, role: Role, name_part: str = "") -> Any:
        """Name, shape and pose in the world of every geometry whose name contains a part."""
        inspector = self.scene_graph.model_inspector()
        found = []
        for body_index in self.plant.GetBodyIndices(self.instance):
            body = self.plant.get_body(body_index)
            frame = self.plant.GetBodyFrameIdOrThrow(body_index)
            X_WB = self.plant.EvalBodyPoseInWorld(self.context, body)
            for geometry in inspector.GetGeometries(frame, role):
                if name_part in inspector.GetName(geometry):
                    X_WG = X_WB @ inspector.GetPoseInFrame(geometry)
                    found.append((inspector.GetName(geometry), inspector.GetShape(geometry), X_WG))
        return found


@pytest.fixture(scope="module", params=PEOPLE, ids=str)
def parsed(request: pytest.FixtureRequest) -> Parsed:
    return Parsed(PEOPLE[request.param])


def lowest_point(shape: Any, X_WG: RigidTransform) -> float:
    """Height of the lowest point of a primitive."""
    up = X_WG.rotation().matrix()[2]
    name = type(shape).__name__
    if name == "Sphere":
        reach = shape.radius()
    elif name == "Ellipsoid":
        reach = np.linalg.norm(up * (shape.a(), shape.b(), shape.c()))
    elif name == "Box":
        reach = np.abs(up) @ shape.size() / 2
    elif name == "Capsule":
        reach = shape.radius() + abs(up[2]) * shape.length() / 2
    elif name == "Cylinder":
        reach = np.hypot(up[0], up[1]) * shape.radius() + abs(up[2]) * shape.length() / 2
    else:
        raise NotImplementedError(name)
    return float(X_WG.translation()[2] - reach)


def test_the_committed_model_file_is_up_to_date() -> None:
    assert COMMITTED.read_bytes() == to_sdf(human()).encode(), "run `humanwalk model`"


def test_writer_is_deterministic() -> None:
    assert to_sdf(human()) == to_sdf(human())


def test_names_of_siblings_are_unique() -> None:
    model = ET.fromstring(to_sdf(human())).find("model")
    assert model is not None
    for element in (model, *model.findall("link")):
        names = [child.get("name") for child in element if child.get("name")]
        assert len(names) == len(set(names))


def test_counts(parsed: Parsed) -> None:
    plant = parsed.plant
    assert plant.GetModelInstanceName(parsed.instance) == "human"
    assert len(plant.GetBodyIndices(parsed.instance)) == 44
    revolute = [j for j in map(plant.get_joint, plant.GetJointIndices(parsed.instance)) if isinstance(j, RevoluteJoint)]
    assert len(revolute) == 42
    assert plant.num_actuators() == 42
    assert (plant.num_positions(), plant.num_velocities()) == (49, 48)
    assert plant.GetBodyByName("Pelvis").is_floating_base_body()


def test_actuators_come_in_the_skeletons_order_with_its_values(parsed: Parsed) -> None:
    actuators = [parsed.plant.get_joint_actuator(i) for i in parsed.plant.GetJointActuatorIndices()]
    for actuator, joint in zip(actuators, parsed.skeleton.joints, strict=True):
        assert actuator.name() == joint.name
        assert actuator.effort_limit() == pytest.approx(joint.effort_limit_N_m, rel=1e-8)
        assert actuator.default_rotor_inertia() == pytest.approx(joint.rotor_inertia, rel=1e-8)
        assert actuator.default_gear_ratio() == 1.0


def test_joints_have_the_skeletons_axes_ranges_and_damping(parsed: Parsed) -> None:
    for expected in parsed.skeleton.joints:
        joint = parsed.plant.GetJointByName(expected.name)
        assert joint.parent_body().name() == expected.parent
        assert joint.child_body().name() == expected.child
        np.testing.assert_allclose(joint.revolute_axis(), expected.axis, atol=1e-12)
        limits = (joint.position_lower_limit(), joint.position_upper_limit())
        np.testing.assert_allclose(np.ravel(limits), expected.range_rad, rtol=1e-8)
        assert joint.default_damping() == pytest.approx(expected.damping, rel=1e-8)


def test_mass_properties_survive_the_file(parsed: Parsed) -> None:
    plant, context, skeleton = parsed.plant, parsed.context, parsed.skeleton
    assert plant.CalcTotalMass(context) == pytest.approx(skeleton.total_mass, rel=1e-8)
    p_WC = plant.CalcCenterOfMassPositionInWorld(context)
    np.testing.assert_allclose(p_WC, skeleton.com, atol=1e-8)
    for segment in skeleton.segments:
        M_BBo = plant.GetBodyByName(segment.name).default_spatial_inertia()
        I_BBcm = M_BBo.Shift(M_BBo.get_com()).CalcRotationalInertia().get_moments()
        np.testing.assert_allclose(I_BBcm, segment.inertia, rtol=1e-5, atol=1e-10)


def test_bodies_have_the_positions_of_the_skeleton(parsed: Parsed) -> None:
    for name, p_WB in parsed.skeleton.origins.items():
        X_WB = parsed.plant.EvalBodyPoseInWorld(parsed.context, parsed.plant.GetBodyByName(name))
        np.testing.assert_allclose(X_WB.translation(), p_WB, atol=1e-8)
        np.testing.assert_allclose(X_WB.rotation().matrix(), np.eye(3), atol=1e-12)


@pytest.mark.parametrize("side", ["Right", "Left"])
def test_sole_frames_lie_on_the_ground_below_the_ankles(parsed: Parsed, side: str) -> None:
    frame = parsed.plant.GetFrameByName(f"{side}Leg_Sole")
    assert frame.body().name() == f"{side}Leg_Ankle"
    X_WF = frame.CalcPoseInWorld(parsed.context)
    ankle = parsed.skeleton.origins[f"{side}Leg_Ankle"]
    np.testing.assert_allclose(X_WF.translation(), (ankle[0], ankle[1], 0.0), atol=1e-8)
    np.testing.assert_allclose(X_WF.rotation().matrix(), np.eye(3), atol=1e-12)


def test_the_collision_shapes_are_six_spheres_under_each_foot(parsed: Parsed) -> None:
    every = parsed.shapes(Role.kProximity)
    assert all(isinstance(shape, Sphere) and SOLE_SET in name for name, shape, _ in every)
    assert [sum(f"{side}Leg{SOLE_SET}" in name for name, _, _ in every) for side in SIDES] == [6, 6]


def test_collision_shapes_rest_on_the_ground(parsed: Parsed) -> None:
    for name, shape, X_WG in parsed.shapes(Role.kProximity):
        assert lowest_point(shape, X_WG) == pytest.approx(0.0, abs=1e-8), name


def test_the_center_of_mass_is_above_the_feet(parsed: Parsed) -> None:
    centers = np.array([X.translation() for _, _, X in parsed.shapes(Role.kProximity)])
    x, y, _ = parsed.skeleton.com
    assert centers[:, 0].min() < x < centers[:, 0].max()
    assert centers[:, 1].min() < y < centers[:, 1].max()


def test_contact_parameters(parsed: Parsed) -> None:
    inspector = parsed.scene_graph.model_inspector()
    for geometry in inspector.GetAllGeometryIds(Role.kProximity):
        properties = inspector.GetProximityProperties(geometry)
        friction = properties.GetProperty("material", "coulomb_friction")
        assert friction.static_friction() == friction.dynamic_friction() == 0.7
        flesh = parsed.skeleton.flesh
        dissipation = properties.GetProperty("material", "hunt_crossley_dissipation")
        assert dissipation == pytest.approx(flesh.sole_dissipation)
        assert properties.GetProperty("material", "relaxation_time") == pytest.approx(flesh.sole_relaxation_time)
        stiffness = properties.GetProperty("material", "point_contact_stiffness")
        assert stiffness == pytest.approx(flesh.sole_stiffness)
        modulus = properties.GetProperty("hydroelastic", "hydroelastic_modulus")
        assert modulus == pytest.approx(flesh.sole_modulus)


def test_soles_sink_by_the_same_share_of_their_length(parsed: Parsed) -> None:
    body, reference = parsed.skeleton, human()
    sunk, usual = (person.total_mass / person.flesh.sole_stiffness / person.stature for person in (body, reference))
    assert sunk == pytest.approx(usual)


def test_nothing_visible_is_below_the_ground(parsed: Parsed) -> None:
    looks = parsed.shapes(Role.kIllustration)
    lowest = min(lowest_point(shape, X_WG) for _, shape, X_WG in looks)
    # The soles stand on the ground: neither in it nor above it.
    assert lowest == pytest.approx(0.0, abs=1e-6)


def test_the_visible_head_ends_at_the_stature(parsed: Parsed) -> None:
    upside_down = RigidTransform(RollPitchYaw(np.pi, 0.0, 0.0), np.zeros(3))
    highest = max(-lowest_point(shape, upside_down @ X_WG) for _, shape, X_WG in parsed.shapes(Role.kIllustration))
    assert highest == pytest.approx(parsed.skeleton.stature, rel=0.003)


def test_every_large_segment_is_visible(parsed: Parsed) -> None:
    seen = {name for name, _, _ in parsed.shapes(Role.kIllustration)}
    for segment in parsed.skeleton.segments:
        if segment.mass > parsed.skeleton.total_mass / 70.0:
            assert any(name.startswith(f"human::{segment.name}_") for name in seen), segment.name


def test_left_and_right_look_like_mirror_images_except_for_color(parsed: Parsed) -> None:
    rights = parsed.shapes(Role.kIllustration, "::Right")
    lefts = {name: (shape, X) for name, shape, X in parsed.shapes(Role.kIllustration, "::Left")}
    assert len(rights) == len(lefts)
    mirror = np.diag([1.0, -1.0, 1.0])
    for name, _, X_WG in rights:
        _, X_WL = lefts[name.replace("Right", "Left")]
        np.testing.assert_allclose(X_WL.translation(), mirror @ X_WG.translation(), atol=1e-8)
        np.testing.assert_allclose(X_WL.rotation().matrix(), mirror @ X_WG.rotation().matrix() @ mirror, atol=1e-8)
