"""A recording as a choice of the scenario: its file, and how its columns are read."""

from dataclasses import dataclass
from pathlib import Path

from humanwalk.body.subject import Subject
from humanwalk.motion.followed import followed_motion
from humanwalk.motion.recorded_motion import MotionMapping, RecordedMotion
from humanwalk.parameter_file import load_as
from humanwalk.quantity import ParameterError, file_path
from humanwalk.terrain import Terrain


@dataclass(frozen=True)
class RecordingFile:
    """A recording of joint angles."""

    angles: str = file_path()
    """A .mot, .sto or .csv file with joint angles; its path counts from the scenario's folder."""

    mapping: str = file_path()
    """A YAML file (`MotionMapping`) that assigns columns to joints and gives their unit; empty: by name."""

    def __post_init__(self) -> None:
        """Raise ParameterError without a recording."""
        if not self.angles:
            raise ParameterError("angles: no recording; allowed: a .mot, .sto or .csv file; name it (--follow FILE)")

    def read(self, subject: Subject, terrain: Terrain, ease_in: float) -> RecordedMotion:
        """The recording as motion of a subject on a terrain, at full speed after `ease_in` seconds.

        Raises:
            ParameterError: the recording or its mapping cannot be used.
        """
        mapping = load_as(MotionMapping, Path(self.mapping)) if self.mapping else MotionMapping()
        return followed_motion(Path(self.angles), mapping, subject, terrain, ease_in)
