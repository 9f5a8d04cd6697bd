"""The summary of a run: speed, lift, steps, support, torques, tracking and cost; each measure has one definition."""

import math
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any, TypedDict

import numpy as np
import pyarrow as pa

from humanwalk.body import SIDES, Side
from humanwalk.measures.effort import cost_of_transport, joint_names
from humanwalk.measures.ends import COMPLETED, FELL
from humanwalk.measures.events import events_of
from humanwalk.measures.fall import FallReport, report_fall
from humanwalk.measures.gait_measures import GaitMeasures, OfFeet, gait_measures, of_feet
from humanwalk.measures.path import distance_along, path_deviation, path_directions
from humanwalk.measures.signals import TIME, matrix
from humanwalk.measures.steady import steady_rows
from humanwalk.numerics import Array, Mask
from humanwalk.quantity import printable
from humanwalk.scenario import Scenario
from humanwalk.walking.push import all_pushes

PACKAGES = ("humanwalk", "drake", "numpy")
"""Packages whose versions a summary names."""


class Summary(TypedDict):
    """The measures of a run, ready for JSON; keys carry their units, None is a number that the run does not have."""

    scenario: str
    description: str
    survived: bool
    end: str
    physics: bool
    duration_s: float
    fall: FallReport | None
    steady_from_s: float | None
    distance_m: float
    mean_speed_m_s: float | None
    commanded_speed_m_s: float | None
    lateral_drift_m: float | None
    path_deviation_m: float | None
    foot_lift_m: OfFeet
    foot_line_error_m: OfFeet
    steps: int | None
    external_support: bool
    style: str | None
    support_force_rms_N: float | None
    support_torque_rms_N_m: float | None
    pelvis_tracking_rms_m: float | None
    torque_rms_N_m: float | None
    tracking_error_rms_rad: float | None
    peak_torque_N_m: dict[str, float | None]
    saturated_share: dict[str, float | None]
    tracking_error_rad: dict[str, float | None]
    ik_converged_share: float | None
    qp_failures: int | None
    cost_of_transport: float | None
    wall_time_s: float
    realtime_factor: float
    versions: dict[str, str]
    seed: int
    gait: GaitMeasures | None


def summarize(scenario: Scenario, signals: pa.Table, end: str, wall_time: float, name: str) -> Summary:
    """Measure a run.

    Distances are along the commanded path, the speed is along its heading. Speed, path deviation, support, tracking and
    cost are those of the steady walk: from `Controller.steady_from` to the end. They are null for a run that ended
    before, as is every number that is not finite. Without physics there are no forces: steps, lift, torques and cost
    are null or empty. Lateral drift and line errors are those of walks along x.

    Args:
        scenario: what was simulated.
        signals: the record.
        end: why the simulation ended, see `humanwalk.measures.ends`.
        wall_time: of the simulation [s].
        name: of the scenario.
    """
    time = signals[TIME].to_numpy()
    controller, physics = scenario.controller, scenario.controller.physics
    steady_from = controller.steady_from(scenario.subject)
    steady = time >= steady_from
    joints = joint_names(signals)
    com = matrix(signals, ["com.x_m", "com.y_m"])
    directions = path_directions(signals, controller.command)
    every, is_along_x = np.ones_like(steady), not directions.travel.imag.any()
    forces, torques = (
        [f"support.{what}_{axis}{unit}" for axis in "xyz"] for what, unit in (("force", "_N"), ("torque", "_N_m"))
    )
    cost = cost_of_transport(signals, steady, scenario.subject.mass, distance_along(signals, steady, directions.travel))
    supported = forces[0] in signals.column_names
    pushes = all_pushes(scenario.pushes, scenario.seed)
    summary: Summary = {
        "scenario": printable(name),
        "description": printable(scenario.description, 1000),
        "survived": end == COMPLETED,
        "end": end,
        "physics": physics,
        "duration_s": float(time[-1]),
        "fall": report_fall(signals, scenario.subject.mass, pushes) if end == FELL else None,
        "steady_from_s": steady_from,
        "distance_m": distance_along(signals, every, directions.travel),
        "mean_speed_m_s": _rate(time[steady], distance_along(signals, steady, directions.facing)),
        "commanded_speed_m_s": controller.commanded_speed,
        "lateral_drift_m": float(com[-1, 1] - com[0, 1]) if is_along_x else None,
        "path_deviation_m": path_deviation(signals, steady, controller.command),
        "foot_lift_m": of_feet(lambda side: foot_lift(signals, side) if physics else None),
        "foot_line_error_m": of_feet(lambda side: foot_line_error(signals, side) if is_along_x else None),
        "steps": sum(events_of(signals, side).touchdowns.size for side in SIDES) if physics else None,
        "external_support": supported,
        "style": controller.followed_style,
        "support_force_rms_N": _rms_norm(matrix(signals, forces), steady) if supported else 0.0,
        "support_torque_rms_N_m": _rms_norm(matrix(signals, torques), steady) if supported else 0.0,
        "pelvis_tracking_rms_m": pelvis_tracking(signals, steady),
        "torque_rms_N_m": _rms(matrix(signals, [f"{name}.torque_N_m" for name in joints]), steady) if joints else None,
        "tracking_error_rms_rad": _rms(tracking_errors(signals, joints), steady) if joints else None,
        "peak_torque_N_m": {name: float(np.abs(signals[f"{name}.torque_N_m"].to_numpy()).max()) for name in joints},
        "saturated_share": {name: float(signals[f"{name}.saturated"].to_numpy().mean()) for name in joints},
        "tracking_error_rad": {name: _rms(tracking_errors(signals, [name]), steady) for name in joints},
        "ik_converged_share": ik_converged_share(signals),
        "qp_failures": qp_failures(signals),
        "cost_of_transport": cost if physics else None,
        "wall_time_s": wall_time,
        "realtime_factor": float(time[-1]) / wall_time,
        "versions": {name: version(name) for name in PACKAGES},
        "seed": scenario.seed,
        "gait": gait_measures(signals, steady_rows(signals, scenario), directions.facing) if physics else None,
    }
    finite: Summary = _finite(summary)
    return finite


def foot_lift(signals: pa.Table, side: Side) -> float | None:
    """Median over the strides of the sole's greatest height [m] above the higher of the places where it stands before
    and after the swing; None without strides.
    """
    height = signals[f"{side.lower()}_sole.z_m"].to_numpy()
    strides = [height[begin:end] for begin, end in events_of(signals, side).strides]
    if not strides:
        return None
    ground = np.array([stride.min() for stride in strides])
    higher = np.maximum(ground, np.append(ground[1:], ground[-1]))
    return float(np.median([stride.max() for stride in strides] - higher))


def foot_line_error(signals: pa.Table, side: Side) -> float:
    """Greatest lateral distance of a sole from the line along x through its initial position [m]."""
    y = signals[f"{side.lower()}_sole.y_m"].to_numpy()
    return float(np.abs(y - y[0]).max())


def pelvis_tracking(signals: pa.Table, rows: Mask) -> float | None:
    """Root mean square distance of the pelvis from its walking reference [m]."""
    if "pelvis.reference_x_m" not in signals.column_names:
        return None
    actual = matrix(signals, [f"pelvis.{axis}_m" for axis in "xyz"])
    wanted = matrix(signals, [f"pelvis.reference_{axis}_m" for axis in "xyz"])
    return _rms_norm(actual - wanted, rows)


def qp_failures(signals: pa.Table) -> int | None:
    """Number of QP failures of the whole-body program; None without such a program."""
    if "qp.failures" not in signals.column_names:
        return None
    counts = signals["qp.failures"].to_numpy()
    return int(counts[np.isfinite(counts)].max(initial=0))


def tracking_errors(signals: pa.Table, joints: Sequence[str]) -> Array:
    """Desired minus actual angles of joints [rad], shape (rows, joints)."""
    desired, actual = (
        matrix(signals, [f"{joint}.{which}_rad" for joint in joints]) for which in ("desired_angle", "angle")
    )
    return desired - actual


def ik_converged_share(signals: pa.Table) -> float | None:
    """Share of the samples at which a leg's inverse kinematics had converged; None where none was solved."""
    columns = [f"{side.lower()}_leg.ik_converged" for side in SIDES]
    return float(matrix(signals, columns).mean()) if columns[0] in signals.column_names else None


def _finite(value: Any) -> Any:
    """The value with None for numbers that JSON cannot represent."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _rate(time: Array, distance: float) -> float | None:
    return distance / float(time[-1] - time[0]) if time.size > 1 else None


def _rms(values: Array, rows: Mask) -> float | None:
    """Root mean square of all values, shape (rows, n), in the chosen rows; None if there are none."""
    return float(np.sqrt((values[rows] ** 2).mean())) if rows.any() else None


def _rms_norm(vectors: Array, rows: Mask) -> float | None:
    """Root mean square length of vectors, shape (rows, n), in the chosen rows; None if there are none."""
    return float(np.sqrt((vectors[rows] ** 2).sum(axis=1).mean())) if rows.any() else None
