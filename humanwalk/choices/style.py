"""Styles of the balanced walk: whether hips, knees and ankles also follow given angles over the gait cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from humanwalk.body.joint_map import JointMap
from humanwalk.body.subject import Subject
from humanwalk.choices.recording_file import RecordingFile
from humanwalk.control.joint_style import JointStyle
from humanwalk.control.whole_body_parameters import TaskGains, critical
from humanwalk.motion.gait_curves import normative_curves
from humanwalk.motion.recorded_strides import RecordedGait, recorded_gait
from humanwalk.quantity import quantity
from humanwalk.terrain import Plane


class Style(Protocol):
    """A style of the balanced walk: a dataclass whose fields are those of its tag."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    def task(self, subject: Subject, joints: JointMap) -> JointStyle | None:
        """The task for a subject; None without a style.

        Raises:
            ParameterError: the angles cannot be used.
        """


@dataclass(frozen=True)
class NoStyle:
    """Steps and balance alone determine the angles."""

    def task(self, subject: Subject, joints: JointMap) -> JointStyle | None:
        return None


@dataclass(frozen=True)
class NormativeStyle:
    """Angles of people at the same dimensionless speed: curves that the walk is scored with."""

    gains: TaskGains = critical(300.0, 0.1)

    ankle: float = quantity(0.01, "", 0.0, 10.0)
    """Weight of the ankles relative to hips and knees. The angle of a loaded ankle follows from the knee and from the
    rockers of the foot; a greater weight moves the center of pressure and costs moments (docs/likeness_trials.md,
    "Should the style follow the ankle?")."""

    def task(self, subject: Subject, joints: JointMap) -> JointStyle | None:
        curves = normative_curves(subject.skeleton.hip_height)
        return JointStyle(joints, curves, self.gains, self.ankle)


@dataclass(frozen=True)
class RecordedStyle(RecordingFile):
    """Angles of the mean stride of a recording."""

    gains: TaskGains = critical(300.0, 5.0)

    def task(self, subject: Subject, joints: JointMap) -> JointStyle | None:
        return JointStyle(joints, self.gait(subject).curves, self.gains)

    def gait(self, subject: Subject) -> RecordedGait:
        """The recorded walk of a subject.

        Raises:
            ParameterError: the recording or its mapping cannot be used, or is not a walk.
        """
        return recorded_gait(self.read(subject, Plane(), ease_in=0.0), subject, self.angles)


STYLES: dict[str, type[Style]] = {"none": NoStyle, "normative": NormativeStyle, "recorded": RecordedStyle}
"""Styles by tag."""
