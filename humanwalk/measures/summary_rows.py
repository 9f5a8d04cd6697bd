"""The main figures of a summary as text, for terminals and notebooks."""

from collections.abc import Iterator, Mapping
from typing import Any

from humanwalk.quantity import printable

EXTERNAL_SUPPORT = "EXTERNAL SUPPORT"
"""Shown for every run that had it, even before there is a value."""


def summary_title(summary: Mapping[str, Any]) -> str:
    """Scenario, end and duration of a run in one line."""
    return f"{printable(summary['scenario'])}: {summary['end']} at {summary['duration_s']:.2f} s"


def summary_rows(summary: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Name, value and unit of each figure that the run has."""
    for name, value, form, unit in _figures(summary):
        if value is not None:
            yield name, format(value * (100 if unit == "cm" else 1), form), unit
        elif name.startswith(EXTERNAL_SUPPORT):
            yield name, "-", unit


def _figures(summary: Mapping[str, Any]) -> Iterator[tuple[str, Any, str, str]]:
    """Name, value in SI units, format and shown unit."""
    commanded = summary["commanded_speed_m_s"]
    speed = "mean speed" if commanded is None else f"mean speed (commanded {commanded:g})"
    yield speed, summary["mean_speed_m_s"], ".3f", "m/s"
    yield "distance", summary["distance_m"], ".2f", "m"
    yield "steps", summary["steps"], "d", ""
    for side in ("right", "left"):
        yield f"{side} foot lift", summary["foot_lift_m"][side], ".1f", "cm"
        yield f"{side} foot lateral deviation", summary["foot_line_error_m"][side], ".2f", "cm"
    yield "lateral drift", summary["lateral_drift_m"], ".2f", "cm"
    yield "deviation from the path", summary["path_deviation_m"], ".2f", "cm"
    yield "pelvis tracking error, rms", summary["pelvis_tracking_rms_m"], ".2f", "cm"
    if summary["external_support"]:
        yield f"{EXTERNAL_SUPPORT} force, rms", summary["support_force_rms_N"], ".0f", "N"
        yield f"{EXTERNAL_SUPPORT} torque, rms", summary["support_torque_rms_N_m"], ".0f", "N m"
    yield "style", summary["style"], "", ""
    yield "QP failures", summary["qp_failures"], "d", ""
    if summary["physics"]:
        name, torque = max(summary["peak_torque_N_m"].items(), key=lambda item: item[1] or 0.0)
        yield f"peak torque, {name}", torque, ".0f", "N m"
        yield "cost of transport", summary["cost_of_transport"], ".2f", ""
    yield "real-time factor", summary["realtime_factor"], ".2f", ""
