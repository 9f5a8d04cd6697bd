"""Optional packages: the extras of pyproject.toml."""

from typing import Literal

from humanwalk.quantity import ParameterError

Extra = Literal["c3d", "diagram", "slurm", "study", "video"]


def install_command(extra: Extra) -> str:
    """Command that installs the packages of an extra; humanwalk itself is not on the package index."""
    return f"in the checkout run: pip install -e '.[{extra}]'"


def missing_package(package: str, extra: Extra) -> ParameterError:
    """The error for an optional package that is not installed."""
    return ParameterError(
        f"{package}: not installed; allowed: the packages of the extra {extra}; {install_command(extra)}"
    )
