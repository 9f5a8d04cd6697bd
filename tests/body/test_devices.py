"""Devices: a passive ankle prosthesis and exoskeletons on the skeleton, their torque profiles and their look."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.body import human
from humanwalk.body.devices import DEVICES, AnkleExoskeleton, AnkleProsthesis, Assistance, HipExoskeleton
from humanwalk.body.impairments import NO_TORQUE
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import body_plant
from humanwalk.body.subject import Subject
from humanwalk.body.visuals import visuals
from humanwalk.quantity import ParameterError

PROFILE = Assistance("Right", LEGS["Right"].ankle, -20.0, 0.53, 0.25, 0.10, known=True)


@pytest.mark.parametrize("kind", DEVICES)
def test_the_body_with_a_device_has_the_same_joints(kind: str) -> None:
    subject = Subject(devices=(DEVICES[kind](),))
    assert JointMap.of(body_plant(subject)).names == JointMap.of(body_plant(Subject())).names
    assert kind.replace("_", " ") in str(subject)


def test_a_prosthesis_has_its_own_masses_and_no_muscles() -> None:
    body = AnkleProsthesis(shank_mass=2.1, foot_mass=0.9, side="Left").applied(human())
    left = LEGS["Left"]
    feet = [segment.mass for segment in body.segments if segment.name.startswith(("LeftLeg_Ankle", "LeftLeg_Foot"))]
    assert body.segment(left.shank).mass == 2.1
    assert sum(feet) == pytest.approx(0.9)
    distal = (*left.ankle_joints, left.midfoot, left.toes)
    changed = {new.name for new, old in zip(body.joints, human().joints, strict=True) if new != old}
    assert changed == set(distal)
    for name in distal:
        joint = body.joint(name)
        assert joint.effort_limit_N_m == NO_TORQUE
        locked = joint.range_rad[1] - joint.range_rad[0] < 0.01
        assert locked != (joint.stiffness > 0.0)


def test_a_pylon_is_light_so_that_the_center_of_mass_is_nearer_to_the_knee() -> None:
    shank = LEGS["Right"].shank
    natural, pylon = (body.segment(shank).com for body in (human(), AnkleProsthesis().applied(human())))
    assert pylon[:2] == natural[:2]
    assert 0.0 > pylon[2] > 0.9 * natural[2]


def test_the_ankle_of_a_prosthesis_is_a_spring_and_a_damper() -> None:
    ankle = AnkleProsthesis(stiffness=333.0, damping=4.0, rest_angle=0.05).applied(human()).joint(LEGS["Right"].ankle)
    assert (ankle.stiffness, ankle.damping, ankle.rest_angle) == (333.0, 4.0, 0.05)


def test_a_prosthesis_is_drawn_instead_of_the_shank() -> None:
    parts = {(visual.body, visual.part) for visual in visuals(AnkleProsthesis(side="Right").applied(human()))}
    assert (LEGS["Right"].shank, "pylon") in parts
    assert (LEGS["Right"].shank, "hem") not in parts
    assert (LEGS["Left"].shank, "hem") in parts


@pytest.mark.parametrize(
    ("device", "bodies"),
    [
        (AnkleExoskeleton(mass=0.7), ["RightLeg_Tibia", "LeftLeg_Tibia"]),
        (HipExoskeleton(mass=0.7, side="Left"), ["LeftLeg_Femur_Thigh"]),
    ],
)
def test_an_exoskeleton_is_welded_to_the_legs_and_drawn(
    device: AnkleExoskeleton | HipExoskeleton, bodies: list[str]
) -> None:
    body = device.applied(human())
    assert body.joints == human().joints
    assert body.total_mass == pytest.approx(70.0 + 0.7 * len(bodies))
    added = [weld for weld in body.welds if weld not in human().welds]
    assert [weld.parent for weld in added] == bodies
    assert {weld.child for weld in added} <= {visual.body for visual in visuals(body)}
    assert [torque.side for torque in device.assistance()] == [body.partition("Leg")[0] for body in bodies]


def test_ankles_are_assisted_in_plantarflexion_and_hips_in_flexion() -> None:
    (ankle, _), (hip, _) = AnkleExoskeleton(20.0).assistance(), HipExoskeleton(10.0).assistance()
    assert (ankle.joint, ankle.peak) == (LEGS["Right"].ankle, -20.0)
    assert (hip.joint, hip.peak) == (LEGS["Right"].hip_flexion, 10.0)


@given(st.floats(0.0, 1.0))
def test_the_torque_has_the_sign_of_its_peak_and_is_never_greater(phase: float) -> None:
    assert -20.0 <= PROFILE.torque(phase) <= 0.0


@given(peak_phase=st.floats(0.0, 1.0), rise=st.floats(0.02, 0.5), fall=st.floats(0.02, 0.5), phase=st.floats(0.0, 1.0))
def test_the_torque_is_periodic_and_continuous(peak_phase: float, rise: float, fall: float, phase: float) -> None:
    profile = dataclasses.replace(PROFILE, peak_phase=peak_phase, rise=rise, fall=fall)
    assert profile.torque(peak_phase) == pytest.approx(profile.peak)
    assert profile.torque(0.0) == pytest.approx(profile.torque(1.0))
    # The slope of the cubic is at most 1.5 per rise or fall.
    assert abs(profile.torque(phase + 1e-4) - profile.torque(phase)) <= 1.6e-4 / min(rise, fall) * 20.0


def test_the_torque_is_zero_before_it_rises_and_after_it_falls() -> None:
    assert [PROFILE.torque(phase) for phase in (0.0, 0.27, 0.64, 0.9)] == [0.0] * 4
    rising = [PROFILE.torque(phase) for phase in np.linspace(0.29, 0.53, 9)]
    assert (np.diff(rising) < 0.0).all()


@pytest.mark.parametrize("second", [HipExoskeleton(), HipExoskeleton(peak_torque=5.0, side="Right")])
def test_a_segment_carries_one_frame(second: HipExoskeleton) -> None:
    with pytest.raises(ParameterError, match=r"^subject\.hip_exoskeleton\.side: RightLeg_\w+ already has a frame;"):
        _ = Subject(devices=(HipExoskeleton(), second)).skeleton
    left, right = HipExoskeleton(side="Left"), HipExoskeleton(side="Right")
    assert len(Subject(devices=(left, right)).assistance) == 2


def test_a_leg_has_one_prosthesis() -> None:
    left, right = AnkleProsthesis(side="Left"), AnkleProsthesis(side="Right")
    with pytest.raises(
        ParameterError, match=r"^subject\.ankle_prosthesis\.side: the left leg already has a prosthesis;"
    ):
        _ = Subject(devices=(left, right, left)).skeleton
    both = Subject(devices=(left, right)).skeleton
    assert all(both.segment(LEGS[side].shank).hidden for side in ("Right", "Left"))


def test_the_walkers_model_lacks_an_unknown_exoskeleton() -> None:
    subject = Subject(devices=(AnkleExoskeleton(known=False),))
    assert subject.known_skeleton == Subject().skeleton != subject.skeleton
    assert not any(torque.known for torque in subject.assistance)
