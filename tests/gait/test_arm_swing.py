"""Arms: against the legs, hanging at rest, rates exact."""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.gait.arm_swing import ArmSwingParameters, arm_joints, arm_swing

P = ArmSwingParameters()
JOINTS = {f"{side}Arm{joint}Motion" for side in ("Right", "Left") for joint in ("Shoulder", "Elbow")}


class JointTarget(NamedTuple):
    angle: float
    rate: float


def arm_targets(parameters, *phases, **speeds):
    """Targets of all joints at a phase."""
    swing, rate = arm_swing(*phases, **speeds)
    return {
        name: JointTarget(joint.middle + joint.amplitude * swing, joint.amplitude * rate)
        for name, joint in arm_joints(parameters).items()
    }


def test_names_are_the_thesis_own():
    assert set(arm_targets(P, 0.0, 1.0)) == JOINTS


def test_an_arm_is_back_when_its_foot_lands_in_front():
    arms = arm_targets(P, 0.0, 1.0)
    assert arms["RightArmShoulderMotion"].angle == pytest.approx(-P.shoulder_amplitude)
    assert arms["LeftArmShoulderMotion"].angle == pytest.approx(P.shoulder_amplitude)


def test_arms_hang_at_rest():
    arms = arm_targets(P, 0.3, 0.0, speed_fraction=0.0)
    assert arms["RightArmShoulderMotion"] == (0.0, 0.0)
    assert arms["LeftArmElbowMotion"] == (P.elbow_flexion, 0.0)


@given(phase=st.floats(0.0, 1.0))
def test_the_left_arm_is_the_right_arm_half_a_cycle_later(phase):
    now, later = arm_targets(P, phase, 1.0), arm_targets(P, phase + 0.5, 1.0)
    for joint in ("Shoulder", "Elbow"):
        assert now[f"LeftArm{joint}Motion"] == pytest.approx(later[f"RightArm{joint}Motion"])


@given(
    phase=st.floats(0.0, 1.0),
    rate=st.floats(0.0, 3.0),
    fraction=st.floats(0.0, 1.0),
    growth=st.floats(-1.0, 1.0),
)
def test_rates_are_the_limits_of_differences(phase, rate, fraction, growth):
    h = 1e-5
    ahead, behind = (arm_targets(P, phase + s * rate, rate, fraction + s * growth, growth) for s in (h, -h))
    for name, target in arm_targets(P, phase, rate, fraction, growth).items():
        difference = (ahead[name].angle - behind[name].angle) / (2 * h)
        assert target.rate == pytest.approx(difference, abs=1e-6)


@given(flexion=st.floats(0.0, 1.5), amplitude=st.floats(0.0, 0.5), phase=st.floats(0.0, 1.0))
def test_the_elbow_never_bends_backwards(flexion, amplitude, phase):
    p = ArmSwingParameters(elbow_flexion=flexion, elbow_amplitude=amplitude)
    assert arm_targets(p, phase, 1.0)["RightArmElbowMotion"].angle >= 0.0


@pytest.mark.parametrize("field", ["shoulder_amplitude", "elbow_flexion", "elbow_amplitude"])
@pytest.mark.parametrize("value", [-0.1, 20.0, np.nan])
def test_values_out_of_range_are_refused(field, value):
    with pytest.raises(ValueError, match=f"{field}: .*allowed"):
        ArmSwingParameters(**{field: value})
