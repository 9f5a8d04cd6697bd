"""What many tests look at: the reference human, as data and as a plant for kinematics."""

import pytest

from humanwalk.body import LEG_JOINTS
from humanwalk.body.plant import Subject, kinematics_plant
from humanwalk.control.inverse_kinematics import LegKinematics
from humanwalk.control.joint_map import JointMap
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait


@pytest.fixture(scope="session")
def plant():
    """The finalised reference human; it holds no state, tests make contexts of their own."""
    return kinematics_plant(Subject())


@pytest.fixture(scope="session")
def skeleton():
    return Subject().skeleton


@pytest.fixture(scope="session")
def joints(plant):
    return JointMap.of(plant)


@pytest.fixture(scope="session")
def legs(plant):
    """The chain from pelvis to sole of each leg."""
    return {side: LegKinematics(plant, "Pelvis", f"{side}Leg_Sole", names) for side, names in LEG_JOINTS.items()}


@pytest.fixture(scope="session")
def gait(skeleton):
    """The thesis' walk: L 0.5 m, H 0.2 m, offset 5 cm, 1.4 m/s."""
    return WalkingGait(FootPathParameters(), skeleton.hip_half_width, SpeedRamp(1.4, 0.365))
