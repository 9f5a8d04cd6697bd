"""A choice of one's own needs a class and a tag: no other code changes (docs/architecture.md, Extensions)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from humanwalk.body.joint_map import JointMap
from humanwalk.choices import ACTUATIONS, CONTACTS, CONTROLLERS, PdActuation, PointContact, ThesisController
from humanwalk.choices.controller import JointCommand
from humanwalk.diagrams.walker import make_walker
from humanwalk.numerics import Array
from humanwalk.parameter_file import fields_of
from humanwalk.quantity import ParameterError, quantity
from humanwalk.run.recorder import Recorder
from humanwalk.scenario import Scenario, dump_scenario, parse_scenario
from humanwalk.systems.signal import Signal
from humanwalk.terrain import PIECES, TERRAINS, Course, Face, Piece, Plane


@dataclass(frozen=True)
class Plateau(Plane):
    """Level ground at a height."""

    rise: float = quantity(0.3, "m", 0.0, 1.0)
    """Its height."""

    def height(self, xy: Array) -> Any:
        return super().height(xy) + self.rise


@dataclass(frozen=True)
class Kerf(Piece):
    """Level ground with a slit across."""

    slit: float = quantity(0.1, "m", 0.01, 1.0)
    """Its extent along x."""

    def faces(self, width: float) -> list[Face]:
        begin, end = 1.0, 1.0 + self.slit
        return [
            self.across((0.0, begin), width, 0.0),
            self.across((begin, end), width, -0.3),
            self.across((end, 2.0 + self.slit), width, 0.0),
        ]


@dataclass(frozen=True)
class Slippery(PointContact):
    """Point contact on ground that is more slippery than its terrain."""

    def ground_properties(self, friction: float) -> Any:
        return super().ground_properties(0.5 * friction)


@dataclass(frozen=True)
class Statue(ThesisController):
    """Holds the start posture, and records a number of its own."""

    def add_to(self, world: Any) -> Any:
        n = len(world.joints.names)
        posture = world.add("statue", ConstantVectorSource(np.zeros(2 * n))).get_output_port()
        answer = world.add("answer", ConstantVectorSource([42.0]))
        answer.signals = (Signal("answer", answer.get_output_port(), ("statue.answer",)),)
        return JointCommand(posture)


@dataclass(frozen=True)
class Soft(PdActuation):
    """PD with a tenth of every gain."""

    def install(self, plant: MultibodyPlant, kp: Any, kd: Any) -> None:
        super().install(plant, 0.1 * kp, 0.1 * kd)


@pytest.fixture
def scenario(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A scenario of four choices that humanwalk does not ship, out of a file."""
    for registry, tag, kind in (
        (TERRAINS, "plateau", Plateau),
        (CONTACTS, "slippery", Slippery),
        (CONTROLLERS, "statue", Statue),
        (ACTUATIONS, "soft", Soft),
    ):
        monkeypatch.setitem(registry, tag, kind)
    return parse_scenario(
        "terrain: {plateau: {rise: 0.2}}\ncontact: slippery\ncontroller: statue\nactuation: {soft: {law: implicit}}"
    )


def test_a_file_names_them_with_their_own_fields(scenario: Any) -> None:
    assert scenario.terrain == Plateau(rise=0.2)
    assert (scenario.contact, scenario.controller) == (Slippery(), Statue())
    assert scenario.actuation == Soft(law="implicit")
    assert parse_scenario(dump_scenario(scenario)) == scenario
    assert "terrain.plateau.rise" in dict(fields_of(Scenario))


def test_the_body_starts_on_the_terrain(scenario: Any) -> None:
    walker = make_walker(scenario)
    soles = walker.GetOutputPort("soles").Eval(walker.CreateDefaultContext())
    np.testing.assert_allclose(soles[[2, 5]], 0.2, atol=1e-3)


def test_signals_of_a_new_system_are_recorded(scenario: Any) -> None:
    builder = DiagramBuilder()
    walker = builder.AddNamedSystem("walker", make_walker(scenario))
    recorder = Recorder.add_to(builder, walker, JointMap.of(walker.GetSubsystemByName("plant")), 0.004)
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(0.008)
    table = recorder.table(simulator.get_context())
    assert table["statue.answer"].to_pylist() == [42.0] * 3


def test_a_course_takes_a_new_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PIECES, "kerf", Kerf)
    scenario = parse_scenario("terrain: {course: {pieces: [{kerf: {slit: 0.2}}, slope, kerf]}}\ncontroller: balanced")
    assert isinstance(scenario.terrain, Course)
    assert scenario.terrain.pieces[0] == Kerf(slit=0.2)
    assert parse_scenario(dump_scenario(scenario)) == scenario
    x = np.array((1.9, 2.1, 2.3))
    np.testing.assert_array_equal(scenario.terrain.height(np.column_stack((x, 0.0 * x))), (0.0, -0.3, 0.0))
    with pytest.raises(ParameterError, match=r"terrain\.course\.pieces\.0\.kerf\.slit: 2 is out of range"):
        parse_scenario("terrain: {course: {pieces: [{kerf: {slit: 2}}]}}")
    make_walker(scenario)
