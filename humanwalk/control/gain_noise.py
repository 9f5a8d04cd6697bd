"""Random errors of gains: those of a real body are not known exactly."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from humanwalk.control.whole_body_parameters import PrescribedGains, TaskGains, WholeBodyParameters
from humanwalk.numerics import Array


def gain_factors(size: int, noise: float, random: np.random.Generator) -> Array:
    """Log-normal random factors with median 1, shape (size,); `noise` is the standard deviation of their logarithm."""
    factors: Array = np.exp(noise * random.standard_normal(size))
    return factors


def noisy_tasks(parameters: WholeBodyParameters, noise: float, random: np.random.Generator) -> WholeBodyParameters:
    """Multiply stiffness and damping of each task by random factors; weights do not change."""
    changed: dict[str, Any] = {}
    for field in fields(parameters):
        gains = getattr(parameters, field.name)
        if isinstance(gains, TaskGains | PrescribedGains):
            stiffness, damping = gain_factors(2, noise, random).tolist()
            changed[field.name] = replace(gains, stiffness=gains.stiffness * stiffness, damping=gains.damping * damping)
    return replace(parameters, **changed)
