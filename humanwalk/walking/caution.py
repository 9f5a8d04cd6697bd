"""Careful steps, which are shorter, quicker and higher: on uneven ground, and after a disturbance of balance.

People, too, take shorter and quicker steps when they are perturbed (Hak et al. 2012).
"""

from collections.abc import Iterable
from dataclasses import dataclass

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, quantity


@dataclass(frozen=True)
class Caution:
    """When steps are careful, and how high the foot is lifted in them; their duration is `timing.step`.

    The caution of an ordinary step is 0, that of a careful step 1. Between them duration and lift are interpolated.
    """

    free_error: float = quantity(0.2, "m", 0.0, 1.0)
    """Largest error of the DCM at touchdown that is predicted during a step, up to which the next step is an ordinary
    one. In an undisturbed walk of 0.7 to 1.4 m/s it is 0.08 to 0.18 m."""

    full_error: float = quantity(0.35, "m", 0.0, 2.0)
    """Error from which on the next step is a careful one."""

    full_height: float = quantity(0.03, "m", 0.001, 0.5)
    """Height from which on a step is a careful one: of a foothold above or below the plane of the foot before it, or of
    what the swinging foot clears."""

    memory: float = quantity(0.5, "", 0.0, 0.95)
    """Share of the caution of a step that remains in the next one."""

    pause_error: float = quantity(0.75, "m", 0.0, 10.0)
    """Error from which on the next step on irregular footholds has no forward speed if the DCM is behind the new foot:
    steps up and down last long, and on a tread a foothold corrects little. In undisturbed walks of the default
    man on stairs, boxes, stones and beams the error is 0.2 to 0.53 m, after a push of 10 N s on stairs 0.9 m
    (docs/decisions/0049-pushes-on-stairs.md). With 0.6 m a man of 1.95 m whose soles are longer than the treads paused
    without a push, and fell in 5 of 10 walks up stairs; with 0.75 m in none of these."""

    lift: float = quantity(0.045, "m", 0.0, 0.3)
    """Rise of the ankle above its height at toe-off in a careful step, if that is more than in an ordinary one."""

    def __post_init__(self) -> None:
        """Raise ParameterError if the errors are not in ascending order."""
        if self.full_error < self.free_error:
            raise ParameterError(
                f"full_error: {self.full_error:g} is too small; allowed: free_error, {self.free_error:g} m, or more"
            )

    def after(self, previous: float, error: float) -> float:
        """The caution of a step after one with another caution and an error of the DCM [m]."""
        span = max(self.full_error - self.free_error, 1e-9)
        return max(clip((error - self.free_error) / span, 0.0, 1.0), self.memory * previous)

    def on_ground(self, heights: Iterable[float]) -> float:
        """The caution for rises and heights of the next steps [m]."""
        return min(max(map(abs, heights), default=0.0) / self.full_height, 1.0)

    def lift_above(self, ordinary: float, caution: float) -> float:
        """Rise of the ankle [m] in a step, from the rise in an ordinary one."""
        return ordinary + caution * max(self.lift - ordinary, 0.0)
