"""The shorthands of the command line: their grammar, and the fields that they set."""

import inspect
import math
import re
from dataclasses import dataclass
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.devices import AnkleProsthesis, HipExoskeleton
from humanwalk.body.impairments import HipContracture, JointImpairment, ShortLeg, StiffKnee
from humanwalk.body.loads import AnkleWeights, Backpack, Suitcase
from humanwalk.body.subject import Subject
from humanwalk.choices import CONTROLLERS
from humanwalk.cli import shorthands
from humanwalk.cli.changes import Changes, takes_changes
from humanwalk.cli.main import app
from humanwalk.cli.shorthands import BEARINGS, push_of, push_overrides, terrain_overrides
from humanwalk.quantity import ParameterError, quantity
from humanwalk.scenario import Scenario, load_scenario, shipped_scenarios
from humanwalk.terrain import PIECES, TERRAINS, Course, Piece, Plane
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.slope import Flat, Slope
from humanwalk.terrain.steps import Curb, Obstacle, Stairs
from humanwalk.walking.push import Push

positive = st.floats(0.001, 1000.0, allow_nan=False)


def changed(scenario: str = "walk", **changes: Any) -> Scenario:
    return load_scenario(scenario, Changes(**changes).overrides(scenario))


# --push


@pytest.mark.parametrize(
    ("field", "changes"),
    [
        ("terrain.plane.friction_coefficient=0.3", {"terrain": "slope 3 deg"}),
        ("pushes.given.0.body=Head", {"push": ["30 N s at 2 s from behind"]}),
        ("subject.mass=80", {"mass": 70.0}),
    ],
)
def test_a_field_that_a_shorthand_replaces_is_not_set(field: str, changes: dict[str, Any]) -> None:
    with pytest.raises(
        ParameterError, match=rf"^--set {field.partition('=')[0]}: another option replaces .*; leave one"
    ):
        changed(set_=[field], **changes)


def test_a_shorthand_may_replace_a_part_of_what_is_set() -> None:
    subject = changed(set_=["subject={mass: 80, stature: 1.9}", "pushes.random_interval=0"], mass=70.0).subject
    assert (subject.mass, subject.stature) == (70.0, 1.9)


def test_a_push_is_read_from_its_words() -> None:
    assert push_of("60 N s at 8 s from behind") == Push(time=8.0, impulse=60.0, direction=0.0)
    everything = push_of("3.5e1 N s at 2 s from the left for 0.3 s on the Head")
    assert everything == Push(time=2.0, duration=0.3, impulse=35.0, direction=-math.pi / 2, body="Head")


@pytest.mark.parametrize(
    "text", ["60Ns at 8s from behind", "60 N*s at 8 s from behind", " 60 N·s  at 8 s from behind "]
)
def test_spaces_around_units_are_free(text: str) -> None:
    assert push_of(text) == push_of("60 N s at 8 s from behind")


@given(
    impulse=positive,
    time=positive,
    bearing=st.floats(-360.0, 360.0),
    duration=st.floats(0.001, 60.0, allow_nan=False),
)
def test_a_push_points_away_from_where_it_comes_from(
    impulse: float, time: float, bearing: float, duration: float
) -> None:
    push = push_of(f"{impulse!r} N s at {time!r} s from {bearing!r} deg for {duration!r} s")
    assert (push.impulse, push.time, push.duration) == (impulse, time, duration)
    # x forward, y left; its source lies against the force.
    source = (-push.force[0], -push.force[1])
    size = math.hypot(*source)
    assert source[0] / size == pytest.approx(math.cos(math.radians(bearing)), abs=1e-9)
    assert source[1] / size == pytest.approx(math.sin(math.radians(bearing)), abs=1e-9)


@pytest.mark.parametrize("side", BEARINGS)
def test_the_sides_have_the_signs_of_the_world(side: str) -> None:
    x, y, _ = push_of(f"10 N s at 1 s from {side}").force
    toward = {"front": (-100, 0), "behind": (100, 0), "left": (0, -100), "right": (0, 100)}[side]
    assert (x, y) == pytest.approx(toward, abs=1e-9)


@pytest.mark.parametrize(
    "text",
    ["", "60 at 8", "60 N at 8 s from behind", "60 N s at 8 s", "60 N s at 8 s from above", "60 N s from behind"],
)
def test_another_text_is_refused_with_the_grammar(text: str) -> None:
    with pytest.raises(ParameterError, match=r"not a push; allowed: IMPULSE N s at TIME s from SIDE"):
        push_of(text)


@pytest.mark.parametrize("angle", ["1e999", "1e308", "-360.5"])
def test_an_angle_of_more_than_a_turn_is_refused(angle: str) -> None:
    with pytest.raises(ParameterError, match=r"from: .* is out of range; allowed: -360 to 360 deg"):
        push_of(f"30 N s at 1 s from {angle} deg")


@pytest.mark.parametrize(
    "change",
    [
        {"impairment": ["short leg left right 3 cm"]},
        {"impairment": ["short leg 3 cm, 5 cm"]},
        {"device": ["ankle prosthesis left, side right"]},
        {"terrain": "stairs up down"},
        {"terrain": "stairs 17 cm, rise 18 cm"},
        {"terrain": "plane slope 3 deg, slope 5 deg"},
    ],
)
def test_a_field_that_is_given_twice_is_refused(change: dict[str, Any]) -> None:
    fields = "side|length|direction|rise|slope|shortening|difference"
    with pytest.raises(ParameterError, match=rf"({fields}) is given twice"):
        changed(**change)


def test_pushes_replace_those_of_the_scenario() -> None:
    texts = ["60 N s at 8 s from behind", "30 N s at 9 s from the right"]
    assert changed("push", push=texts).pushes.given == tuple(push_of(text) for text in texts)
    with pytest.raises(ParameterError, match=r"--push 5000 N s at 8 s from behind: impulse: 5000 is out of range"):
        load_scenario("walk", push_overrides(["5000 N s at 8 s from behind"]))


# --terrain


@pytest.mark.parametrize(
    ("text", "terrain"),
    [
        ("plane", Plane()),
        ("slope 3 deg", Plane(slope=math.radians(3.0))),
        ("slope 0.05", Plane(slope=0.05)),
        ("plane cross slope -2deg,friction_coefficient 0.5", Plane(0.0, math.radians(-2.0), 0.5)),
    ],
)
def test_a_terrain_is_read_from_its_words(text: str, terrain: Plane) -> None:
    assert changed(terrain=text).terrain == terrain


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("plain", "did you mean plane"),
        ("slop 3 deg", "did you mean slope"),
        ("plane friction 0.5", "did you mean friction_coefficient"),
        ("slope 3 furlongs", "furlongs is no unit of slope, which has rad or deg"),
        ("friction coefficient 0.5", "plane and course have these fields; .* begin with one of them"),
        ("plane friction coefficient 0.5 kg", "kg is no unit of friction_coefficient, which has none"),
        ("plane slope", "slope is not FIELD VALUE"),
        ("", "no such terrain"),
    ],
)
def test_another_terrain_is_refused_with_the_grammar(text: str, problem: str) -> None:
    with pytest.raises(ParameterError, match=problem) as refusal:
        terrain_overrides(text)
    assert shorthands.TERRAIN_GRAMMAR in str(refusal.value)


@pytest.mark.parametrize(
    ("text", "pieces"),
    [
        ("stairs", (Stairs(),)),
        ("stairs down 17 cm, number 8", (Stairs(rise=0.17, number=8, direction="down"),)),
        ("stairs rise 17 cm, direction down", (Stairs(rise=0.17, direction="down"),)),
        ("rough 3 cm, seed 5 then obstacle 20 cm", (Rough(height=0.03, seed=5), Obstacle(height=0.2))),
        ("slope 3 deg, length 4 m then flat", (Slope(slope=math.radians(3.0), length=4.0), Flat())),
        (
            "curb 12cm then flat 2 m  then curb down 12 cm",
            (Curb(height=0.12), Flat(), Curb(height=0.12, direction="down")),
        ),
    ],
)
def test_a_course_is_read_from_its_pieces(text: str, pieces: tuple[Piece, ...]) -> None:
    assert changed(terrain=text).terrain == Course(pieces=pieces)


@pytest.mark.parametrize("tag", sorted(PIECES.keys() - {"slope", "height_map"}))
def test_every_piece_can_be_written(tag: str) -> None:
    assert changed(terrain=tag.replace("_", " ")).terrain == Course(pieces=(PIECES[tag](),))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("roughly 3 cm then flat", "no such kind"),
        ("stairsdown 17 cm then flat", "no such kind"),
        ("stairs then stares", "no such kind; allowed: .* did you mean stairs"),
        ("obstacle high 20 cm", "high 20 cm is not FIELD VALUE of obstacle, which has .*height"),
        ("stairs sideways", "sideways is not FIELD VALUE of stairs, which has .*direction"),
        ("curb 12 furlongs", "furlongs is no unit of height, which has m or cm or mm"),
        ("obstacle down", "down is not FIELD VALUE of obstacle"),
        ("slope down 3 deg then flat", "down 3 deg is not FIELD VALUE of slope, which has"),
        ("curb -12 cm", r"--terrain curb -12 cm: height: -0.12 is out of range"),
        ("stairs number 2.5", "terrain.course.pieces.0.stairs.number"),
    ],
)
def test_another_piece_is_refused(text: str, problem: str) -> None:
    with pytest.raises(ParameterError, match=problem):
        changed(terrain=text)


def test_a_field_of_several_terrains_needs_the_terrain(monkeypatch: pytest.MonkeyPatch) -> None:
    @dataclass(frozen=True)
    class Hills(Plane):
        height_of_hills: float = quantity(0.1, "m", 0.0, 1.0)

    monkeypatch.setitem(TERRAINS, "hills", Hills)
    with pytest.raises(ParameterError, match=r"plane and hills have these fields; .* begin with one of them"):
        terrain_overrides("slope 3 deg")
    assert changed(terrain="height_of_hills 20 cm").terrain == Hills(height_of_hills=0.2)


@pytest.mark.parametrize(
    ("changes", "range_and_fix"),
    [
        (
            {"impairment": ["stiff knee left 100 deg"]},
            "angle: 1.74533 is out of range; allowed: 0 to 1.5 rad; the nearest",
        ),
        ({"terrain": "slope 100 deg"}, "slope: 1.74533 is out of range; allowed: -0.5 to 0.5 rad; the nearest"),
        (
            {"terrain": "flat then slope 100 deg"},
            "slope: 1.74533 is out of range; allowed: -0.5 to 0.5 rad; the nearest",
        ),
        ({"terrain": "curb 300 cm"}, "height: 3 is out of range; allowed: 0.01 to 0.4 m; the nearest"),
        ({"load": ["backpack 100 kg"]}, "mass: 100 is out of range; allowed: 0.1 to 80 kg; the nearest"),
        (
            {"push": ["9 N s at 1 s from behind for 100 s"]},
            "duration: 100 is out of range; allowed: 0.001 to 60 s; the nearest",
        ),
    ],
)
def test_a_value_with_its_unit_is_not_taken_for_one_in_another(changes: dict[str, Any], range_and_fix: str) -> None:
    (option,) = changes
    with pytest.raises(ParameterError, match=re.escape(range_and_fix)) as refusal:
        changed(**changes)
    assert str(refusal.value).startswith(f"--{option} ")


def test_a_value_without_a_unit_may_be_in_another() -> None:
    with pytest.raises(ParameterError, match=r"if it is in degrees, write 0\.1745"):
        changed(impairment=["stiff knee left 10"])


# --speed, --mass, --stature


@pytest.mark.parametrize("name", shipped_scenarios())
def test_the_speed_is_the_greatest_that_is_commanded(name: str) -> None:
    faster = changed(name, speed=0.75)
    assert faster.controller.commanded_speed == 0.75
    assert faster.subject == load_scenario(name).subject


def test_commanded_speeds_change_in_proportion_and_turns_stay() -> None:
    points = changed("corner", speed=0.8).controller.command.points
    assert [(point.forward, point.turn) for point in points] == [(0.8, 0.0), (0.8, 0.4), (0.8, 0.0)]
    stops = changed("start_stop", speed=0.8).controller.command.points
    assert [point.forward for point in stops] == [0.8, 0.0]


def test_a_walker_that_steps_sideways_gets_the_speed_too() -> None:
    (point,) = changed("sideways", speed=0.8).controller.command.points
    assert (point.forward, point.sideways) == (0.8, 0.3)


def test_the_speed_is_that_of_the_controller_chosen_by_set() -> None:
    balanced = changed("thesis", speed=0.8, set_=["controller=balanced"]).controller
    assert isinstance(balanced, CONTROLLERS["balanced"])
    assert balanced.commanded_speed == 0.8


def test_a_recording_has_its_own_speed() -> None:
    with pytest.raises(ParameterError, match="--speed 1: a recording has its own speed"):
        changed("thesis", speed=1.0, set_=["controller={recorded: {angles: walk.mot}}"])


def test_the_body_is_scaled() -> None:
    subject = changed(mass=60.0, stature=1.6).subject
    assert (subject.mass, subject.stature) == (60.0, 1.6)


def test_the_person_is_described() -> None:
    subject = changed(sex="female", age=8.0, mass=26.0, stature=1.28).subject
    assert subject == Subject(26.0, 1.28, "female", 8.0)


def test_impairments_and_devices_are_described() -> None:
    texts = ["stiff knee left 10 deg", "short_leg 3 cm", "hip contracture both stiffness 20 N m/rad, angle 0.2 unknown"]
    assert changed(impairment=texts).subject.impairments == (
        StiffKnee(math.radians(10.0), side="Left"),
        ShortLeg(0.03),
        HipContracture(0.2, 20.0, side="Both", known=False),
    )
    assert changed(impairment=["short leg 3 cm left"]).subject.impairments == (ShortLeg(0.03, "Left"),)
    assert changed(impairment=["joint joint elbow, upper 90 deg"]).subject.impairments == (
        JointImpairment("elbow", upper=math.radians(90.0)),
    )
    assert changed(impairment=["joint joint hip_flexion, both, upper 0 deg"]).subject.impairments == (
        JointImpairment("hip_flexion", side="Both", upper=0.0),
    )
    assert (
        changed(impairment=["stiff_knee left"]).subject.impairments
        == changed(impairment=["stiff knee left"]).subject.impairments
    )
    assert changed(device=["ankle prosthesis left", "hip exoskeleton 15 N m"]).subject.devices == (
        AnkleProsthesis(side="Left"),
        HipExoskeleton(15.0),
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("stif knee", "did you mean stiff_knee"),
        ("short leg 3 km", "km is no unit of shortening, which has m or cm or mm"),
        ("weak plantarflexors both strength 60 %", "% is no unit of strength, which has none; allowed: IMPAIRMENT"),
        ("stiff knee bend 3", "bend 3 is not FIELD VALUE of stiff_knee, which has angle, play, side, known"),
    ],
)
def test_an_impairment_that_cannot_be_read_is_refused(text: str, message: str) -> None:
    with pytest.raises(ParameterError, match=re.escape(message)):
        changed(impairment=[text])


def test_loads_are_described() -> None:
    texts = ["backpack 10 kg", "ankle weights 1.5 kg unknown", "suitcase 8 kg in the left hand"]
    assert changed(load=texts).subject.loads == (
        Backpack(10.0),
        AnkleWeights(1.5, known=False),
        Suitcase(8.0, side="Left"),
    )


@pytest.mark.parametrize(
    "text", ["backpack", "bag 3 kg", "backpack 3 lb", "vest 3 kg in the right foot", "backpack -kg"]
)
def test_what_is_no_load_is_refused_with_the_grammar(text: str) -> None:
    with pytest.raises(ParameterError, match=r"not a load; allowed: LOAD MASS kg .* backpack, vest"):
        changed(load=[text])


def test_a_load_without_a_hand_is_in_none() -> None:
    with pytest.raises(ParameterError, match=r"subject\.loads\.0\.backpack\.side: no such field|side: no such field"):
        changed(load=["backpack 3 kg in the left hand"])


def test_the_description_tells_what_was_changed() -> None:
    changes = {"speed": 1.2, "terrain": "slope 3 deg", "push": ["9 N s at 1 s from behind"]}
    text = changed("walk", **changes).description
    assert text == "1.0 m/s on its own feet; changed: speed 1.2 m/s, slope 3 deg, push 9 N s at 1 s from behind"
    assert changed("walk", speed=1.2, set_=["description=mine"]).description == "mine"
    assert changed("walk", set_=["duration=5"]).description == load_scenario("walk").description


# Commands.


def options() -> list[inspect.Parameter]:
    def command(changes: Changes) -> None:
        raise NotImplementedError

    return list(inspect.signature(takes_changes(command)).parameters.values())


def test_walk_and_diagram_take_the_same_changes() -> None:
    names = {option.name for option in options()}
    having = [
        command.callback.__name__
        for command in app.registered_commands
        if command.callback is not None and names <= inspect.signature(command.callback).parameters.keys()
    ]
    assert {"walk", "diagram"} <= set(having)


@pytest.mark.parametrize(
    "part",
    [
        shorthands.PUSH_GRAMMAR,
        shorthands.SIDES_GRAMMAR,
        shorthands.PUSH_EXAMPLE,
        shorthands.TERRAIN_GRAMMAR,
        *shorthands.TERRAIN_EXAMPLES,
        shorthands.LOAD_GRAMMAR,
        shorthands.LOAD_EXAMPLE,
    ],
)
def test_help_has_the_grammars(part: str) -> None:
    assert part in " ".join(option.annotation.__metadata__[0].help for option in options())
