"""The plant alone in the motion of a recorded walk: the reference for the cost of all other systems."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import ExternallyAppliedSpatialForce
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder, EventStatus, InputPort, PortDataType

from humanwalk.bench.cost import Cost, cost_of
from humanwalk.diagrams.world import add_world
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.run.simulate import Prepared
from humanwalk.scenario import Scenario


@dataclass
class PlantRecord:
    """Inputs of a plant in every step of a walk.

    Attributes:
        time: Start of every step [s].
        inputs: Values of every connected input port at these times, by the port's name: arrays, or lists of
            ExternallyAppliedSpatialForce.
        start, end: Plant state [q; v] at the first and at the last time.
    """

    time: list[float] = field(default_factory=list)
    inputs: dict[str, list[Array | list[ExternallyAppliedSpatialForce]]] = field(default_factory=dict)
    start: Array = field(default_factory=lambda: np.zeros(0))
    end: Array = field(default_factory=lambda: np.zeros(0))


def record_plant(prepared: Prepared) -> PlantRecord:
    """Have a simulation that has not begun record its plant's inputs, by its monitor.

    Raises:
        ParameterError: It has no discrete plant.
    """
    plant = prepared.plant
    if plant is None:
        raise ParameterError(
            "controller: recorded without physics has no plant to measure; allowed: kinematic: false; set it"
        )
    if plant.time_step() == 0:
        raise ParameterError("simulation.integrator: cenic cannot be split; allowed: discrete; set it")
    record = PlantRecord()
    candidates = [plant.get_input_port(i) for i in range(plant.num_input_ports())]
    # Geometry is the bare plant's own.
    candidates.remove(plant.get_geometry_query_input_port())
    ports: list[InputPort] = []

    def keep(root_context: Context) -> EventStatus:
        context = plant.GetMyContextFromRoot(root_context)
        if not record.time:
            ports.extend(port for port in candidates if port.HasValue(context))
            record.inputs.update({port.get_name(): [] for port in ports})
            record.start = plant.GetPositionsAndVelocities(context).copy()
        record.time.append(root_context.get_time())
        for port in ports:
            record.inputs[port.get_name()].append(port.Eval(context))
        record.end = plant.GetPositionsAndVelocities(context).copy()
        return EventStatus.DidNothing()

    prepared.simulator.set_monitor(keep)
    return record


class BarePlant:
    """The plant of a scenario that repeats a recorded walk; its inputs are fixed for every step."""

    def __init__(self, scenario: Scenario, record: PlantRecord) -> None:
        """Build the plant, in the first recorded state."""
        builder = DiagramBuilder()
        self.plant = add_world(builder, scenario, visuals=False).plant
        self.simulator = Simulator(builder.Build())
        self._context = self.plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        self._record = record
        self._step = 0
        # Ports that never have a value stay unconnected.
        inputs = {name: values for name, values in record.inputs.items() if any(len(value) for value in values)}
        self._feeds = [(self._fix(name), values) for name, values in inputs.items()]
        self._feed()
        self.plant.SetPositionsAndVelocities(self._context, record.start)
        self.simulator.Initialize()

    def _fix(self, name: str) -> Callable[[Array | list[ExternallyAppliedSpatialForce]], None]:
        port = self.plant.GetInputPort(name)
        if port.get_data_type() == PortDataType.kVectorValued:
            fixed = port.FixValue(self._context, np.zeros(port.size()))
            return lambda value: fixed.GetMutableData().get_mutable_value().SetFromVector(value)

        def fix(value: Array | list[ExternallyAppliedSpatialForce]) -> None:
            forces = Value([ExternallyAppliedSpatialForce()])
            forces.set_value(value)
            port.FixValue(self._context, forces)

        return fix

    def _feed(self) -> None:
        for feed, values in self._feeds:
            feed(values[self._step])

    def advance(self, until: float) -> Cost:
        """Advance to a simulated time [s]; returns the cost of the steps alone.

        Raises:
            ParameterError: The last state differs from the recorded one.
        """
        cost = Cost(0.0, 0.0)
        times = self._record.time
        while self._step + 1 < len(times) and times[self._step + 1] <= until + 1e-9:
            self._feed()
            self._step += 1
            end = times[self._step]
            cost += cost_of(lambda end=end: self.simulator.AdvanceTo(end))  # type: ignore[misc]
        if self._step + 1 == len(times) and not np.array_equal(
            self.plant.GetPositionsAndVelocities(self._context), self._record.end
        ):
            raise ParameterError(
                "bench: the bare plant does not repeat the walk bit by bit, so their costs cannot be compared; "
                "allowed: scenarios whose plant depends on its input ports alone"
            )
        return cost
