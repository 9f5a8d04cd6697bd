"""Records the signals of a walker or playback while it is simulated."""

from __future__ import annotations

from dataclasses import dataclass

import pyarrow as pa
from pydrake.systems.framework import Context, Diagram, DiagramBuilder
from pydrake.systems.primitives import LogVectorOutput, Multiplexer, VectorLogSink

from humanwalk.body.joint_map import JointMap
from humanwalk.measures.signals import TIME
from humanwalk.systems.signal import Signal, signals_of, state_columns


def recorded_signals(walker: Diagram, joints: JointMap) -> list[Signal]:
    """The plant's state and every `Signal` of a walker's subsystems."""
    state = Signal("state", walker.GetOutputPort("state"), state_columns(joints))
    return [state, *signals_of(walker.GetSystems())]


@dataclass(frozen=True)
class Recorder:
    """A log of all signals of a diagram inside a root diagram.

    Attributes:
        columns: names of the columns, in the order of the log.
        sink: the log of all signals, one after the other: one event per sample, not one per signal.
    """

    columns: tuple[str, ...]
    sink: VectorLogSink

    @staticmethod
    def add_to(builder: DiagramBuilder, walker: Diagram, joints: JointMap, period: float) -> Recorder:
        """Record the plant's state and every `Signal` of the walker's subsystems, sampled every `period` seconds."""
        signals = recorded_signals(walker, joints)
        every = builder.AddSystem(Multiplexer([len(signal.columns) for signal in signals]))
        for i, signal in enumerate(signals):
            builder.Connect(walker.GetOutputPort(signal.name), every.get_input_port(i))
        columns = tuple(column for signal in signals for column in signal.columns)
        return Recorder(columns, LogVectorOutput(every.get_output_port(), builder, period))

    def table(self, context: Context) -> pa.Table:
        """Everything recorded so far in a root context, a row per sample; also after a simulation that ended early."""
        log = self.sink.FindLog(context)
        # Copies: the log's memory goes with the context.
        data = dict(zip(self.columns, log.data().copy(), strict=True))
        return pa.table({TIME: log.sample_times().copy()} | data)
