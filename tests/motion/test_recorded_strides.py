"""A recorded walk has its own speed, step duration and mean stride."""

import numpy as np
import pytest

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.motion.gait_curves import normative_curves
from humanwalk.motion.recorded_motion import RecordedMotion
from humanwalk.motion.recorded_strides import recorded_gait
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.sides import Side

SUBJECT = Subject()
CURVES = normative_curves(SUBJECT.skeleton.hip_height)
SPEED, STEP = 0.9, 0.58


def recording(duration: float = 5.0, speed: float = SPEED, heading: float = 0.0) -> RecordedMotion:
    """People's curves at a speed, the right touchdown at 0.2 s, along a heading [rad]."""
    time = np.arange(0.0, duration, 0.01)
    joints = JointMap.of(kinematics_plant(SUBJECT))
    angles: Array = np.zeros((time.size, len(joints.names)))
    for side, offset in zip(SIDES, (0.0, 0.5), strict=True):
        phase = (time - 0.2) / (2.0 * STEP) + offset
        columns = [joints.names.index(name) for name in LEGS[side].sagittal]
        angles[:, columns] = [CURVES.at(side, value, SPEED).value for value in phase]
    way = speed * time
    path = np.column_stack((np.cos(heading) * way, np.sin(heading) * way, 0.0 * time + 0.93))
    return RecordedMotion(time, angles, np.zeros((time.size, 3)), path, ease_in=0.0)


def test_speed_and_step_are_those_of_the_recording() -> None:
    gait = recorded_gait(recording(), SUBJECT, "trial")
    assert gait.speed == pytest.approx(SPEED, abs=1e-3)
    assert gait.step == pytest.approx(STEP, abs=0.005)
    assert gait.curves.lowest_speed == gait.speed


def in_sequence(*parts: RecordedMotion) -> RecordedMotion:
    """Recordings one after the other, each from where the one before ended."""
    times, positions = [parts[0].time], [parts[0].pelvis_position]
    for part in parts[1:]:
        times.append(times[-1][-1] + 0.01 + part.time)
        positions.append(positions[-1][-1] + part.pelvis_position - part.pelvis_position[0])
    time, angles = np.concatenate(times), np.concatenate([part.angles for part in parts])
    return RecordedMotion(time, angles, np.zeros((time.size, 3)), np.concatenate(positions), ease_in=0.0)


def stand(posture: Array, duration: float = 5.0) -> RecordedMotion:
    """A posture that sways by 0.6 degrees at 0.8 Hz."""
    time = np.arange(0.0, duration, 0.01)
    angles: Array = posture + 0.01 * np.sin(5.0 * time)[:, None]
    path = np.tile([0.0, 0.0, 0.93], (time.size, 1))
    return RecordedMotion(time, angles, np.zeros((time.size, 3)), path, ease_in=0.0)


def test_standing_before_after_and_within_the_walk_is_not_counted() -> None:
    walk = recording()
    begin, end = stand(0.0 * walk.angles[0]), stand(walk.angles[-1])
    for motion in (in_sequence(begin, walk, end), in_sequence(walk, begin, walk)):
        gait = recorded_gait(motion, SUBJECT, "trial")
        assert gait.speed == pytest.approx(SPEED, abs=0.01)
        assert gait.step == pytest.approx(STEP, abs=0.01)


def test_the_speed_is_that_along_the_walk() -> None:
    assert recorded_gait(recording(heading=0.3), SUBJECT, "trial").speed == pytest.approx(SPEED, abs=1e-3)


@pytest.mark.parametrize("side", SIDES)
def test_the_mean_stride_begins_at_touchdown(side: Side) -> None:
    """People's foot is farthest ahead of the pelvis 2 to 3 % of the cycle before touchdown."""
    gait = recorded_gait(recording(), SUBJECT, "trial")
    for phase in (0.1, 0.45, 0.8):
        errors = [
            np.abs(gait.curves.at(side, phase, SPEED).value - CURVES.at(side, phase - lead, SPEED).value).max()
            for lead in (0.01, 0.02, 0.03, 0.04)
        ]
        assert min(errors) < np.radians(2.5)


def of_two_rows(duration: float) -> RecordedMotion:
    motion = recording()
    first = (motion.angles[:2], motion.pelvis_angles[:2], motion.pelvis_position[:2])
    return RecordedMotion(np.array([0.0, duration]), *first, ease_in=0.0)


@pytest.mark.parametrize(
    "motion, message",
    [
        (recording(1.0), "touchdowns of the"),
        (recording(speed=-SPEED), "the pelvis moves at -0.9"),
        (recording(speed=0.01), "in a stride the pelvis moves by 0.012 m, and the ankle by 0.66 m.*leave out the path"),
        (recording(heading=0.4), "the pelvis moves 23 deg from x; allowed: up to 20 deg; turn the recording"),
        (of_two_rows(3600.0), "0 touchdowns of the"),
        (of_two_rows(1e10), r"1e\+10 s long; allowed: up to 3600 s"),
    ],
)
def test_what_is_not_a_walk_is_refused_in_one_line(motion: RecordedMotion, message: str) -> None:
    with pytest.raises(ParameterError, match=message) as caught:
        recorded_gait(motion, SUBJECT, "trial")
    assert "\n" not in str(caught.value)
