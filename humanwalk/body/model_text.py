"""Numbers as the model files have them, so that all formats hold the same ones."""

from collections.abc import Iterable


def numbers(values: Iterable[float]) -> str:
    """Several numbers with blanks between."""
    return " ".join(number(v) for v in values)


def number(value: float) -> str:
    """One number; ten digits keep the arithmetic and drop the rounding noise, "+ 0.0" turns -0 into 0."""
    return f"{round(float(value), 12) + 0.0:.10g}"
