"""What a run records: one row per signal period, one named column with a unit per number."""

import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
from pydrake.systems.framework import Context, Diagram, DiagramBuilder
from pydrake.systems.primitives import LogVectorOutput, Multiplexer, VectorLogSink

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError

TIME = "time_s"


def _xyz(prefix: str, unit: str) -> list[str]:
    return [f"{prefix}{axis}_{unit}" for axis in "xyz"]


def _floating_base(prefix: str) -> list[str]:
    return [
        *(f"{prefix}quaternion_{axis}" for axis in "wxyz"),
        *_xyz(prefix, "m"),
        *_xyz(f"{prefix}angular_velocity_", "rad_s"),
        *_xyz(f"{prefix}velocity_", "m_s"),
    ]


def signal_columns(joints: JointMap) -> dict[str, list[str]]:
    """Column names of every exported port of a walker that is recorded, in the order of the port's elements.

    Names are `thing.quantity_unit`: `RightLegTibiaMotion.angle_rad`, `right_foot.force_z_N`.
    """
    state = [""] * (joints.num_positions + joints.num_positions - 1)
    first_v = joints.num_positions
    pelvis = _floating_base("pelvis.")
    state[:7], state[first_v : first_v + 6] = pelvis[:7], pelvis[7:]
    for name, q, v in zip(joints.names, joints.q, joints.v, strict=True):
        state[q] = f"{name}.angle_rad"
        state[first_v + v] = f"{name}.velocity_rad_s"
    foot = [*_xyz("force_", "N"), *_xyz("cop_", "m"), "free_moment_N_m", "loaded"]
    sides = [side.lower() for side in SIDES]
    return {
        "state": state,
        "desired_state": [
            *(f"{name}.desired_angle_rad" for name in joints.names),
            *(f"{name}.desired_velocity_rad_s" for name in joints.names),
        ],
        "torque": [f"{name}.torque_N_m" for name in joints.names],
        "saturated": [f"{name}.saturated" for name in joints.names],
        "soles": [column for side in sides for column in _xyz(f"{side}_sole.", "m")],
        "com": [*_xyz("com.", "m"), *_xyz("com.velocity_", "m_s")],
        "foot_forces": [f"{side}_foot.{column}" for side in sides for column in foot],
        "phase": [f"{side}_foot.phase" for side in sides],
        "contact_schedule": [f"{side}_foot.scheduled" for side in sides],
        "ik_status": [
            f"{side}_leg.{column}" for column in ("ik_residual", "ik_iterations", "ik_converged") for side in sides
        ],
        "pelvis_reference": _floating_base("pelvis.reference_"),
        "support_wrench": [*_xyz("support.torque_", "N_m"), *_xyz("support.force_", "N")],
        "foot_shift": [
            *(column for side in sides for column in _xyz(f"{side}_foot.shift_", "m")),
            *(column for side in sides for column in _xyz(f"{side}_foot.shift_velocity_", "m_s")),
        ],
        "alpha": [
            "balance.alpha_forward_rad",
            "balance.alpha_left_rad",
            "balance.alpha_forward_rate_rad_s",
            "balance.alpha_left_rate_rad_s",
        ],
        "command": ["command.forward_m_s", "command.sideways_m_s", "command.turn_rad_s"],
        "balance": [
            *(f"{point}.{axis}_m" for point in ("zmp", "dcm", "dcm_reference", "foothold") for axis in "xy"),
            "planner.phase",
        ],
        "qp_status": ["qp.solved", "qp.failures", "qp.failures_in_a_row"],
        "push": _xyz("push.force_", "N"),
        "friction_use": [f"{side}_foot.friction_use" for side in sides],
    }


@dataclass(frozen=True)
class Recorder:
    """What is recorded of a walker inside a root diagram.

    Attributes:
        ports: the exported ports that are logged, and their sizes.
        sink: the log sink of all of these, one after the other: one event a sample, not one a port.
        columns: names of the columns of every port, in the order of the table.
    """

    ports: dict[str, int]
    sink: VectorLogSink
    columns: dict[str, list[str]]

    @staticmethod
    def add_to(builder: DiagramBuilder, walker: Diagram, joints: JointMap, period: float) -> "Recorder":
        """Record every port of the walker that `signal_columns` knows, sampled every `period` seconds."""
        columns = {port: names for port, names in signal_columns(joints).items() if walker.HasOutputPort(port)}
        ports = {port: len(names) for port, names in columns.items()}
        every = builder.AddSystem(Multiplexer(list(ports.values())))
        for place, port in enumerate(ports):
            builder.Connect(walker.GetOutputPort(port), every.get_input_port(place))
        return Recorder(ports, LogVectorOutput(every.get_output_port(), builder, period), columns)

    def table(self, context: Context) -> pa.Table:
        """Everything recorded so far; also after a simulation that ended early.

        Args:
            context: root context of the simulation.
        """
        log = self.sink.FindLog(context)
        if log.num_samples() == 0:
            return pa.table(
                {name: np.empty(0) for name in (TIME, *(n for names in self.columns.values() for n in names))}
            )
        time: Array = log.sample_times().copy()
        ends = np.cumsum(list(self.ports.values()))
        record = dict(zip(self.ports, np.split(log.data().T.copy(), ends[:-1], axis=1), strict=True))
        data: dict[str, Array] = {TIME: time}
        for port, names in self.columns.items():
            data |= zip(names, np.ascontiguousarray(record[port].T), strict=True)
        return pa.table(data)


UNITS = {"N_m": "N m", "rad_s": "rad/s", "m_s": "m/s", "rad": "rad", "m": "m", "N": "N", "s": "s"}
"""Units by how a column's name ends."""
_UNIT = re.compile(f"_({'|'.join(UNITS)})$")


def unit_of(column: str) -> str:
    """Unit of a column, "" for a pure number: "N m" of RightLegTibiaMotion.torque_N_m."""
    found = _UNIT.search(column)
    return UNITS[found[1]] if found else ""


def column_of(columns: Sequence[str], name: str) -> str:
    """The column of a name with or without its unit.

    Raises:
        ParameterError: there is none.
    """
    if name in columns:
        return name
    for column in columns:
        if _UNIT.sub("", column) == name:
            return column
    near = difflib.get_close_matches(name, columns, n=3, cutoff=0.5)
    raise ParameterError(f"{name}: no such signal; allowed: the {len(columns)} of the run; near: {', '.join(near)}")


def matrix(signals: pa.Table, columns: Sequence[str]) -> Array:
    """Columns of a table as an array, shape (rows, len(columns))."""
    return np.column_stack([signals[column].to_numpy() for column in columns])
