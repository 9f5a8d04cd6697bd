"""The PD law of every joint (thesis Eq 4-23 with the sign of the damping corrected, E10)."""

from typing import Literal

from humanwalk.numerics import Array

PdLaw = Literal["implicit", "semi_implicit", "explicit"]
"""Discretization of the law, see `humanwalk.control.pd_laws`."""


def pd_torque(q: Array, v: Array, q_desired: Array, v_desired: Array, kp: Array, kd: Array) -> Array:
    """tau = kp (q_d - q) + kd (v_d - v) [N m], element-wise (Eq 4-23 corrected as in E10)."""
    tau: Array = kp * (q_desired - q) + kd * (v_desired - v)
    return tau
