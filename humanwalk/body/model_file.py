"""Model files of a skeleton, the format chosen by the suffix."""

from collections.abc import Callable
from pathlib import Path

from humanwalk.body.mjcf import to_mjcf
from humanwalk.body.osim import to_osim
from humanwalk.body.sdf import Look, to_sdf
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.urdf import to_urdf
from humanwalk.files import write_text
from humanwalk.quantity import ParameterError, printable

FORMATS: dict[str, Callable[[Skeleton, Look], str]] = {
    ".sdf": to_sdf,
    ".urdf": to_urdf,
    ".xml": to_mjcf,
    ".osim": lambda skeleton, look: to_osim(skeleton),
}
"""Text of a model file by its suffix; an OpenSim model has no shapes, so that its look does not count."""


def write_model(path: Path, skeleton: Skeleton, look: Look = "person") -> None:
    """Write a model file, whole or not at all.

    Raises:
        ParameterError: an unknown suffix, or a file that cannot be written.
    """
    write = FORMATS.get(path.suffix.lower())
    if write is None:
        raise ParameterError(
            f"-o {printable(path)}: unknown model format; allowed: {', '.join(FORMATS)}; name it human.sdf"
        )
    write_text(path, write(skeleton, look))
