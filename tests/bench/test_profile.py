"""Exclusive times, with a clock that is advanced by hand."""

import numpy as np
import pytest
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, DiscreteValues, InputPort, LeafSystem
from pydrake.systems.primitives import Gain

from humanwalk.bench.profile import UPSTREAM, ExclusiveClock, profiled


class HandClock:
    """A clock that is advanced by hand."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now

    def pass_(self, seconds: float) -> None:
        self.now += seconds


@pytest.fixture
def hand() -> HandClock:
    return HandClock()


class Source(LeafSystem):
    """A number that takes 5 s."""

    def __init__(self, hand: HandClock) -> None:
        super().__init__()
        self._hand = hand
        self.DeclareVectorOutputPort("y", 1, self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        self._hand.pass_(5.0)
        output.SetFromVector([1.0])


class Reader(LeafSystem):
    """Reads its input twice and works 2 s, for its output and in its update."""

    def __init__(self, hand: HandClock) -> None:
        super().__init__()
        self._hand = hand
        self._u = self.DeclareVectorInputPort("u", 1)
        self.DeclareDiscreteState(1)
        self.DeclareVectorOutputPort("y", size=1, calc=self._calc)
        self.DeclarePeriodicDiscreteUpdateEvent(0.1, 0.0, self._update)

    def _calc(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._u.Eval(context) + self._u.Eval(context))
        self._hand.pass_(2.0)

    def _update(self, context: Context, state: DiscreteValues) -> None:
        self._u.Eval(context)
        self._hand.pass_(2.0)


def test_time_of_inner_functions_is_not_counted_twice(hand: HandClock) -> None:
    clock = ExclusiveClock(hand)

    def outer() -> None:
        hand.pass_(1.0)
        clock.run("inner", hand.pass_, 3.0)
        clock.run("inner", hand.pass_, 4.0)

    clock.run("outer", outer)
    assert clock.seconds == {"outer": 1.0, "inner": 7.0}
    assert clock.calls == {"outer": 1, "inner": 2}


def test_a_function_that_raises_is_counted_and_raises(hand: HandClock) -> None:
    clock = ExclusiveClock(hand)

    def fail() -> None:
        hand.pass_(1.0)
        raise ValueError

    with pytest.raises(ValueError):
        clock.run("outer", clock.run, "inner", fail)
    assert clock.seconds == {"outer": 0.0, "inner": 1.0}


def test_upstream_computations_do_not_count_for_a_system(hand: HandClock) -> None:
    with profiled(hand) as clock:
        builder = DiagramBuilder()
        source, reader = builder.AddSystem(Source(hand)), builder.AddSystem(Reader(hand))
        # A system of Drake between them counts as upstream.
        between = builder.AddSystem(Gain(3.0, 1))
        builder.Connect(source.get_output_port(), between.get_input_port())
        builder.Connect(between.get_output_port(), reader.get_input_port())
        builder.ExportOutput(reader.get_output_port())
        diagram = builder.Build()
        context = diagram.CreateDefaultContext()
        value = diagram.get_output_port().Eval(context)
        diagram.EvalUniquePeriodicDiscreteUpdate(context)
    assert value == [6.0]
    assert clock.seconds == {"Source": 5.0, "Reader": 4.0, UPSTREAM: 0.0}
    assert clock.calls == {"Source": 1, "Reader": 2, UPSTREAM: 3}


def test_systems_made_outside_of_the_block_are_not_timed(hand: HandClock) -> None:
    before = (InputPort.Eval, LeafSystem.DeclareVectorOutputPort)
    with pytest.raises(ZeroDivisionError), profiled(hand) as clock:
        _ = 1 / 0
    assert (InputPort.Eval, LeafSystem.DeclareVectorOutputPort) == before
    source = Source(hand)
    assert np.array_equal(source.get_output_port().Eval(source.CreateDefaultContext()), [1.0])
    assert clock.seconds == {}
