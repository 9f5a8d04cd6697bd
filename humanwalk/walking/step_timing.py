"""The clock of a step: double support, then single support; it runs faster for a foothold that is out of reach."""

import math
from dataclasses import dataclass, replace

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, quantity

MAX_DOUBLE_SUPPORT = 0.7
"""Largest share of double support in a step (our choice)."""

SHORTEST_STEP = 0.38
"""Shortest step that a walk ratio asks for, per `step`: 0.2 s (our choice)."""


@dataclass(frozen=True)
class StepTiming:
    """Durations of the phases, and limits of the clock's rate."""

    step: float = quantity(0.53, "s", 0.3, 1.2)
    """From touchdown to touchdown of the other foot in a careful step, and in all steps without a walk ratio or forward
    speed."""

    walk_ratio: float = quantity(0.361, "m s", 0.0, 1.0)
    """Length times duration of a step, which in people hardly depends on the speed; 0: all steps take `step`. No step
    is shorter than 0.38 of `step`."""

    longest_step: float = quantity(0.65, "s", 0.3, 1.2)
    """Longest duration for a walk ratio: slow walks have shorter steps instead."""

    sideways_speed: float = quantity(0.2, "m/s", 0.01, 2.0)
    """Sideways speed from which on no step is longer than `step` (our choice): in a walk to the side one foot takes two
    steps' way, and at 0.5 m/s forward and 0.3 m/s sideways the walker fell with steps of 0.65 s."""

    double_support: float = quantity(0.098, "s", 0.04, 0.4)
    """First part of a step that takes `step`."""

    double_support_exponent: float = quantity(1.6, "", 0.0, 3.0)
    """Double support is proportional to this power of the duration of the step: its share is 22 % of the cycle in
    people at 0.9 m/s and 19 % at 1.4 m/s."""

    longest_double_support: float = quantity(0.2, "s", 0.04, 1.0)
    """Longest double support of a step that takes longer than `step`, unless `double_support` is longer. Without this
    limit the walker fell on stairs up with treads of 25 cm, whose steps take 0.9 s
    (docs/decisions/0055-slow-walks.md)."""

    weight_shift: float = quantity(1.0, "s", 0.3, 3.0)
    """From quiet standing onto the first stance foot."""

    early_touchdown: float = quantity(0.85, "", 0.3, 1.0)
    """Fraction of single support after which contact ends the step."""

    phase_rate_gain: float = quantity(15.0, "1/m", 0.0, 100.0)
    """Increase of the clock's rate per distance by which the desired foothold is out of reach."""

    phase_rate_limit: float = quantity(0.8, "", 0.0, 3.0)
    """Largest increase of the rate in single support."""

    double_support_rate_limit: float = quantity(6.0, "", 0.0, 10.0)
    """Largest increase of the rate in double support, for a foothold across the stance foot or a wide one, per share of
    the weight that the new foot carries (docs/decisions/0055-slow-walks.md)."""

    touchdown_force: float = quantity(30.0, "N", 0.0, 500.0)
    """Vertical force above which the swing ends: 4 % of the weight of the body. A heel can rest on the ground with less
    than 60 N; if the swing goes on meanwhile, the step ends up to 40 ms late."""

    loaded_force: float = quantity(60.0, "N", 0.0, 500.0)
    """Vertical force above which a foot counts as loaded: a tenth of the weight of the body."""

    def __post_init__(self) -> None:
        """Raise ParameterError for steps too short to swing a leg."""
        if self.double_support > MAX_DOUBLE_SUPPORT * self.step:
            raise ParameterError(
                f"double_support: {self.double_support:g} is too long for step {self.step:g}; allowed: up to "
                f"{MAX_DOUBLE_SUPPORT * self.step:.3g} s; the rest of the step has to swing the leg"
            )

    def at_velocity(self, velocity: complex, caution: float = 0.0) -> "StepTiming":
        """The timing at a commanded velocity: with the length v T of a step forward, the walk ratio is v T^2.

        Args:
            velocity: Forward + i sideways [m/s].
            caution: From an ordinary step, 0, to a careful one, 1, which is not longer than `step`.
        """
        forward = velocity.real
        if self.walk_ratio == 0.0 or forward <= 0.0:
            return self
        duration = clip(math.sqrt(self.walk_ratio / forward), SHORTEST_STEP * self.step, self.longest_step)
        ordinary = duration / self.step
        share = max(caution, min(abs(velocity.imag) / self.sideways_speed, 1.0))
        return self.stretched(ordinary + share * (min(ordinary, 1.0) - ordinary))

    def stretched(self, factor: float) -> "StepTiming":
        """The timing of a step that takes `factor` times as long."""
        if factor == 1.0:
            return self
        step = factor * self.step
        double_support = factor**self.double_support_exponent * self.double_support
        most = min(max(self.longest_double_support, self.double_support), MAX_DOUBLE_SUPPORT * step)
        return replace(self, step=step, double_support=min(double_support, most))

    @property
    def single_support(self) -> float:
        """Second part of the step [s]."""
        return self.step - self.double_support

    def swing_progress(self, elapsed: float) -> float:
        """Elapsed fraction of single support at a time since touchdown [s]; negative in double support."""
        return (elapsed - self.double_support) / self.single_support

    def has_landed(self, elapsed: float, force: float) -> bool:
        """Whether the swing ends, by time or by early contact.

        Args:
            elapsed: Time since the last touchdown [s].
            force: Vertical ground reaction force on the swinging foot [N].
        """
        progress = self.swing_progress(elapsed)
        return progress >= 1.0 or (progress > self.early_touchdown and force > self.touchdown_force)

    def phase_rate(self, excess: float, limit: float) -> float:
        """Rate of the clock, 1 nominally.

        Args:
            excess: Distance by which the desired foothold is out of reach [m].
            limit: Largest increase of the rate.
        """
        return 1.0 + min(self.phase_rate_gain * excess, limit)
