"""Arm swing: against the legs, hanging at rest, with exact rates."""

from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body.limbs import ARMS
from humanwalk.walking.arm_swing import ArmSwingParameters, arm_joints, arm_swing

P = ArmSwingParameters()
RIGHT, LEFT = ARMS["Right"], ARMS["Left"]


class JointTarget(NamedTuple):
    angle: float
    rate: float


def arm_targets(parameters: ArmSwingParameters, *phases: float, **speeds: Any) -> dict[str, JointTarget]:
    """Targets of all joints at a phase."""
    swing, rate = arm_swing(*phases, **speeds)
    return {
        name: JointTarget(joint.middle + joint.amplitude * swing, joint.amplitude * rate)
        for name, joint in arm_joints(parameters).items()
    }


def test_an_arm_is_back_when_its_foot_lands_in_front() -> None:
    arms = arm_targets(P, 0.0, 1.0)
    assert arms[RIGHT.shoulder_flexion].angle == pytest.approx(-P.shoulder_amplitude)
    assert arms[LEFT.shoulder_flexion].angle == pytest.approx(P.shoulder_amplitude)


def test_arms_hang_at_rest() -> None:
    arms = arm_targets(P, 0.3, 0.0, speed_fraction=0.0)
    assert arms[RIGHT.shoulder_flexion] == (0.0, 0.0)
    assert arms[LEFT.elbow] == (P.elbow_flexion, 0.0)


@given(phase=st.floats(0.0, 1.0))
def test_the_left_arm_is_the_right_arm_half_a_cycle_later(phase: float) -> None:
    now, later = arm_targets(P, phase, 1.0), arm_targets(P, phase + 0.5, 1.0)
    assert now[LEFT.shoulder_flexion] == pytest.approx(later[RIGHT.shoulder_flexion])
    assert now[LEFT.elbow] == pytest.approx(later[RIGHT.elbow])


@given(
    phase=st.floats(0.0, 1.0),
    rate=st.floats(0.0, 3.0),
    fraction=st.floats(0.0, 1.0),
    growth=st.floats(-1.0, 1.0),
)
def test_rates_are_the_limits_of_differences(phase: float, rate: float, fraction: float, growth: float) -> None:
    h = 1e-5
    ahead, behind = (arm_targets(P, phase + s * rate, rate, fraction + s * growth, growth) for s in (h, -h))
    for name, target in arm_targets(P, phase, rate, fraction, growth).items():
        difference = (ahead[name].angle - behind[name].angle) / (2 * h)
        assert target.rate == pytest.approx(difference, abs=1e-6)


@given(flexion=st.floats(0.0, 1.5), amplitude=st.floats(0.0, 0.5), phase=st.floats(0.0, 1.0))
def test_the_elbow_never_extends_beyond_straight(flexion: float, amplitude: float, phase: float) -> None:
    p = ArmSwingParameters(elbow_flexion=flexion, elbow_amplitude=amplitude)
    assert arm_targets(p, phase, 1.0)[RIGHT.elbow].angle >= 0.0


@pytest.mark.parametrize("field", ["shoulder_amplitude", "elbow_flexion", "elbow_amplitude"])
@pytest.mark.parametrize("value", [-0.1, 20.0, np.nan])
def test_values_out_of_range_are_rejected(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"{field}: .*allowed"):
        ArmSwingParameters(**{field: value})
