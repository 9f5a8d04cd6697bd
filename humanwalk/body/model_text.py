"""Numbers as text, the same in all formats of model files."""

from collections.abc import Iterable


def numbers(values: Iterable[float]) -> str:
    """Return numbers separated by blanks."""
    return " ".join(number(v) for v in values)


def number(value: float) -> str:
    """Return a number with ten digits, without rounding noise; "+ 0.0" turns -0 into 0."""
    return f"{round(float(value), 12) + 0.0:.10g}"
