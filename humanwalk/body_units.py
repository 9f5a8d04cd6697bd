"""Parameters of the reference body in the units of another body.

Lengths are measured by the leg length l, masses by the body mass m, times by sqrt(l / g), and so forces by m g and
moments by m g l. Two bodies whose lengths, masses and inertias differ by these units only walk the same walk in them if
all gains, times and speeds do, too (dynamic similarity: Alexander and Jayes 1983; Hof 1996). Parameters are written in
SI units for the reference body; `scaled` converts them by the unit of each field.
"""

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

from humanwalk.quantity import Metadata, ParameterError, changed

Exponents = tuple[int, int, int]
"""Exponents of mass, length and time."""

SYMBOLS: dict[str, Exponents] = {
    "1": (0, 0, 0),
    "rad": (0, 0, 0),
    "kg": (1, 0, 0),
    "m": (0, 1, 0),
    "s": (0, 0, 1),
    "N": (1, 1, -2),
    "Pa": (1, -1, -2),
}
"""Dimensions of the symbols that a unit is composed of."""


@cache
def dimensions(unit: str) -> Exponents:
    """Exponents of mass, length and time of a unit such as "N m s/rad"; of a pure number, "", all are 0.

    Raises:
        ParameterError: The unit has an unknown symbol.
    """
    numerator, _, denominator = unit.partition("/")
    total = [0, 0, 0]
    for factors, sign in ((numerator, 1), (denominator, -1)):
        for factor in factors.split():
            symbol = factor.rstrip("23")
            if symbol not in SYMBOLS:
                known = ", ".join(SYMBOLS)
                raise ParameterError(f"unit: {unit!r} has the unknown symbol {symbol!r}; allowed: {known}; add it")
            power = sign * int(factor.removeprefix(symbol) or 1)
            total = [sum_ + power * exponent for sum_, exponent in zip(total, SYMBOLS[symbol], strict=True)]
    mass, length, time = total
    return mass, length, time


@dataclass(frozen=True)
class BodyScale:
    """Factors from the reference body to another one, at the same gravity.

    Attributes:
        length: Of the leg length.
        mass: Of the mass.
    """

    length: float = 1.0
    mass: float = 1.0

    @property
    def time(self) -> float:
        """Factor of the time sqrt(l / g)."""
        return math.sqrt(self.length)

    def factor(self, unit: str) -> float:
        """Factor of quantities with a unit; see `dimensions`."""
        mass, length, time = dimensions(unit)
        return self.mass**mass * self.length**length * self.time**time


REFERENCE_BODY = BodyScale()


def scaled[T](parameters: T, scale: BodyScale) -> T:
    """Parameters of the reference body, converted to another body by the unit of every `quantity`.

    Args:
        parameters: Tree of dataclasses; for the reference body, every bit of it is kept.
        scale: Factors to the other body.
    """

    def converted(_: str, value: Any, metadata: Metadata) -> Any:
        factor = scale.factor(metadata.get("unit", ""))
        return value if factor == 1.0 else factor * value

    return changed(parameters, converted)
