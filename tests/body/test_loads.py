"""Loads: rigid bodies welded to the person, drawn in every look, and known to its own model or not."""

from typing import Any

import numpy as np
import pytest
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body import Skeleton, human, to_sdf
from humanwalk.body.joint_map import JointMap
from humanwalk.body.loads import LOADS, AnkleWeights, Backpack, Load, Suitcase, Vest, loaded
from humanwalk.body.plant import add_human, kinematics_plant
from humanwalk.body.sdf import LOOKS
from humanwalk.body.subject import Subject

EVERY: tuple[Load, ...] = (Backpack(12.0), Vest(8.0), AnkleWeights(1.5), Suitcase(9.0))
BODIES = {
    "thesis": human(),
    "woman": Subject(60.0, 1.65, "female").body,
    "child": Subject(20.0, 1.10, "male", 6.0).body,
}


def parsed(text: str) -> MultibodyPlant:
    plant = MultibodyPlant(time_step=0.0)
    parser = Parser(plant)
    parser.SetStrictParsing()
    parser.AddModelsFromString(text, "sdf")
    plant.Finalize()
    return plant


def center(skeleton: Skeleton, parent: str) -> Any:
    """Center of mass in W of the load on a segment [m]."""
    (weld,) = [weld for weld in skeleton.welds if weld.parent == parent and weld.child.startswith("Load_")]
    return skeleton.origins[weld.child]


@pytest.mark.parametrize("kind", LOADS)
def test_a_load_adds_its_mass_and_no_joint(kind: str) -> None:
    load = LOADS[kind]()
    body = loaded(human(), [load])
    assert body.total_mass == pytest.approx(70.0 + load.total)
    assert body.joints == human().joints
    assert body.segments[: len(human().segments)] == human().segments
    assert body.stature == human().stature


def test_several_loads_of_one_kind_are_different_bodies() -> None:
    body = loaded(human(), [Suitcase(side="Right"), Suitcase(side="Left"), Backpack(), Backpack()])
    names = [segment.name for segment in body.segments]
    assert len(names) == len(set(names)) == 44 + 4


@pytest.mark.parametrize("body", BODIES)
def test_loads_are_where_they_are_carried(body: str) -> None:
    person = BODIES[body]
    bag = center(loaded(person, [Backpack()]), "Ribs")
    assert bag[0] < -0.1 * person.stature / 1.75
    assert bag[1] == 0.0
    assert person.hip_height < bag[2] < person.stature
    for side, sign in (("Right", -1.0), ("Left", 1.0)):
        case = center(loaded(person, [Suitcase(side=side)]), f"{side}Arm_Hand")  # type: ignore[arg-type]
        assert sign * case[1] > person.hip_half_width
        assert case[2] + 0.15 < person.origins[f"{side}Arm_Hand"][2]
        # Clear of the ground: a child carries the same case.
        assert case[2] - 0.15 > 0.02
        cuff = center(loaded(person, [AnkleWeights()]), f"{side}Leg_Tibia")
        assert person.origins[f"{side}Leg_Ankle"][2] < cuff[2] < person.origins[f"{side}Leg_Tibia"][2]
    vest = loaded(person, [Vest(10.0)])
    front, back = (segment for segment in vest.segments if segment.name.startswith("Load_"))
    assert front.mass == back.mass == 5.0
    np.testing.assert_allclose(vest.origins[front.name][0], -vest.origins[back.name][0])


@pytest.mark.parametrize(
    "load", [Suitcase(9.0, depth=0.5, width=0.1, height=0.3), Backpack(9.0, depth=0.1, height=0.5)]
)
def test_a_load_has_the_inertia_of_a_box_with_its_edges(load: Suitcase | Backpack) -> None:
    (part,) = (segment for segment in loaded(human(), [load]).segments if segment.name.startswith("Load_"))
    x, y, z = np.square((load.depth, load.width, load.height))
    np.testing.assert_allclose(part.inertia, load.mass / 12.0 * np.array((y + z, x + z, x + y)))


@pytest.mark.parametrize("look", LOOKS)
def test_every_part_of_a_load_is_drawn_in_every_look(look: Any) -> None:
    body = loaded(human(), EVERY)
    drawn = {visual.body for visual in LOOKS[look](body)}
    parts = [segment.name for segment in body.segments if segment.name.startswith("Load_")]
    assert len(parts) == 6
    assert set(parts) <= drawn
    names = [visual.name for visual in LOOKS[look](body)]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("body", BODIES)
def test_drake_reads_the_loads_strictly(body: str) -> None:
    skeleton = loaded(BODIES[body], EVERY)
    plant = parsed(to_sdf(skeleton))
    context = plant.CreateDefaultContext()
    assert plant.CalcTotalMass(context) == pytest.approx(skeleton.total_mass, rel=1e-9)
    np.testing.assert_allclose(plant.CalcCenterOfMassPositionInWorld(context), skeleton.com, atol=1e-8)
    assert plant.num_actuators() == 42


def test_the_walker_knows_what_it_is_told() -> None:
    subject = Subject(loads=(Backpack(10.0), Suitcase(5.0, known=False)))
    assert subject.known_mass == 80.0
    model = kinematics_plant(subject)
    assert model.CalcTotalMass(model.CreateDefaultContext()) == pytest.approx(80.0, rel=1e-9)
    plant = MultibodyPlant(time_step=0.0)
    add_human(plant, subject)
    plant.Finalize()
    assert plant.CalcTotalMass(plant.CreateDefaultContext()) == pytest.approx(85.0, rel=1e-9)
    # A state of one is a state of the other.
    assert plant.num_multibody_states() == model.num_multibody_states()
    ours, its = JointMap.of(plant), JointMap.of(model)
    assert ours.names == its.names
    np.testing.assert_array_equal(ours.q, its.q)
