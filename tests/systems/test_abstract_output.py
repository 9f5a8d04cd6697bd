"""An abstract output port: its value, what it depends on, and that it does not keep its system."""

import gc
import weakref

from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, DiagramBuilder, LeafSystem

from humanwalk.systems.abstract_output import declare_abstract_output


class Doubled(LeafSystem):
    """Twice its input, as an abstract value."""

    def __init__(self, of_input_only: bool = True) -> None:
        super().__init__()
        self.calls = 0
        self._input = self.DeclareVectorInputPort("x", 1)
        needs = {self.input_port_ticket(self._input.get_index())} if of_input_only else set()
        declare_abstract_output(self, "doubled", Value(0.0), self._calculate, needs)

    def _calculate(self, context: Context, output: AbstractValue) -> None:
        self.calls += 1
        output.set_value(2.0 * self._input.Eval(context)[0])


def test_the_port_has_the_value_that_the_method_sets() -> None:
    system = Doubled()
    context = system.CreateDefaultContext()
    for x in (1.5, -2.0):
        system.GetInputPort("x").FixValue(context, x)
        assert system.GetOutputPort("doubled").Eval(context) == 2.0 * x


def test_the_value_is_calculated_again_when_a_prerequisite_changes() -> None:
    for of_input_only, calls in ((True, 1), (False, 2)):
        system = Doubled(of_input_only)
        context = system.CreateDefaultContext()
        system.GetInputPort("x").FixValue(context, 1.0)
        for time in (0.0, 1.0):
            context.SetTime(time)
            system.GetOutputPort("doubled").Eval(context)
        assert system.calls == calls


def test_the_port_outlives_the_variable_of_its_system_in_a_diagram() -> None:
    builder = DiagramBuilder()
    builder.ExportInput(builder.AddNamedSystem("system", Doubled()).GetInputPort("x"), "x")
    builder.ExportOutput(builder.GetSubsystemByName("system").GetOutputPort("doubled"), "doubled")
    diagram = builder.Build()
    del builder
    gc.collect()
    context = diagram.CreateDefaultContext()
    diagram.GetInputPort("x").FixValue(context, 3.0)
    assert diagram.GetOutputPort("doubled").Eval(context) == 6.0


def test_the_port_does_not_keep_its_system() -> None:
    reference = weakref.ref(Doubled())
    gc.collect()
    assert reference() is None, "the port holds a strong reference to its system"
