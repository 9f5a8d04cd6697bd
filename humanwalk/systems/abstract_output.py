"""An abstract output port of a LeafSystem whose diagram can be freed."""

from collections.abc import Callable, Collection
from weakref import WeakMethod

from pydrake.common.value import AbstractValue
from pydrake.systems.framework import Context, DependencyTicket, LeafSystem, OutputPort


def declare_abstract_output(
    system: LeafSystem,
    name: str,
    model: AbstractValue,
    calculate: Callable[[Context, AbstractValue], None],
    prerequisites: Collection[DependencyTicket] = (),
) -> OutputPort:
    """Declare an abstract output port.

    pydrake holds the function of such a port out of sight of the garbage collector. A method there would hold its
    system for ever, and with it the diagram. Here the port holds the method weakly.

    Args:
        system: The system.
        name: Name of the port.
        model: Of the port's values.
        calculate: Method of the system that sets the value.
        prerequisites: What the value depends on; all sources if empty.
    """
    method = WeakMethod(calculate)

    def calculate_if_alive(context: Context, output: AbstractValue) -> None:
        if (calculate := method()) is not None:
            calculate(context, output)

    needs = set(prerequisites) or {system.all_sources_ticket()}
    return system.DeclareAbstractOutputPort(name, model.Clone, calculate_if_alive, needs)
