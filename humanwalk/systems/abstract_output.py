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
    """Declare and return an abstract output port.

    pydrake refers to the function of such a port where the garbage collector cannot see it. A method would keep its
    system alive forever, and with it the diagram. The port therefore refers to the method weakly.

    Args:
        system: The system.
        name: Name of the port.
        model: Model value of the port.
        calculate: Method of the system that sets the value.
        prerequisites: What the value depends on; all sources if empty.
    """
    method = WeakMethod(calculate)

    def calculate_of_system(context: Context, output: AbstractValue) -> None:
        bound = method()
        assert bound is not None
        bound(context, output)

    needs = set(prerequisites) or {system.all_sources_ticket()}
    return system.DeclareAbstractOutputPort(name, model.Clone, calculate_of_system, needs)
