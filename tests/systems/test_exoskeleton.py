"""The exoskeleton as a system: ports, heel switches, and torque over the gait cycle."""

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator

from humanwalk.body.devices import AnkleExoskeleton, Assistance, HipExoskeleton
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.numerics import Array
from humanwalk.systems.exoskeleton import Exoskeleton

PERIOD = 0.01
STRIDE = 1.0
PROFILES = (*AnkleExoskeleton(20.0).assistance(), *HipExoskeleton(10.0, known=False).assistance())


@pytest.fixture
def exoskeleton(plant: MultibodyPlant) -> Exoskeleton:
    return Exoskeleton(plant, PROFILES, PERIOD)


def loads(right: float, left: float) -> Array:
    forces = np.zeros((2, 8))
    forces[:, 2] = right, left
    return forces.ravel()


class Walk:
    """Steps of a simulated walk: the right foot touches down at full seconds, the left half a second later."""

    def __init__(self, exoskeleton: Exoskeleton) -> None:
        self.system, self.simulator = exoskeleton, Simulator(exoskeleton)
        self.context = self.simulator.get_mutable_context()

    def to(self, end: float) -> None:
        while self.context.get_time() < end - 0.5 * PERIOD:
            time = self.context.get_time()
            right, left = (600.0 * ((time + shift) % STRIDE < 0.6 * STRIDE) for shift in (0.0, 0.5 * STRIDE))
            self.system.GetInputPort("foot_forces").FixValue(self.context, loads(right, left))
            self.simulator.AdvanceTo(time + PERIOD)

    def output(self, name: str) -> Array:
        return self.system.GetOutputPort(name).Eval(self.context)


def test_ports(exoskeleton: Exoskeleton) -> None:
    inputs = [exoskeleton.get_input_port(i) for i in range(exoskeleton.num_input_ports())]
    assert [(port.get_name(), port.size()) for port in inputs] == [("foot_forces", 16), ("command", 42)]
    outputs = [exoskeleton.get_output_port(i) for i in range(exoskeleton.num_output_ports())]
    assert [(port.get_name(), port.size()) for port in outputs] == [
        ("torque", 42),
        ("known_torque", 42),
        ("generalized_force", 48),
    ]
    (signal,) = exoskeleton.signals
    assert (signal.name, len(set(signal.columns))) == ("exoskeleton_torque", 42)


def test_there_is_no_torque_before_the_second_touchdown(exoskeleton: Exoskeleton) -> None:
    walk = Walk(exoskeleton)
    for time in np.arange(0.05, 1.45, 0.1):
        walk.to(float(time))
        assert not walk.output("torque").any()


@pytest.mark.parametrize("profile", PROFILES)
def test_every_stride_has_the_profile_of_its_foot(
    exoskeleton: Exoskeleton, joints: JointMap, profile: Assistance
) -> None:
    walk, touchdown = Walk(exoskeleton), 3.0 if profile.side == "Right" else 3.5
    walk.to(touchdown + profile.peak_phase)
    torque = walk.output("torque")[joints.names.index(profile.joint)]
    # A heel switch is read up to two periods late.
    assert torque == pytest.approx(profile.torque(profile.peak_phase - 2 * PERIOD), rel=0.1)


def test_generalized_forces_are_the_torques_in_the_order_of_the_velocities(
    exoskeleton: Exoskeleton, joints: JointMap
) -> None:
    walk = Walk(exoskeleton)
    walk.to(3.5)
    force = walk.output("generalized_force")
    assert np.abs(walk.output("torque")).max() > 10.0
    assert np.array_equal(force[joints.v], walk.output("torque"))
    assert not force[:6].any()


def test_only_known_profiles_are_known(exoskeleton: Exoskeleton, joints: JointMap) -> None:
    walk = Walk(exoskeleton)
    walk.to(3.6)
    hips = [joints.names.index(leg.hip_flexion) for leg in LEGS.values()]
    assert walk.output("torque")[hips].any()
    assert not walk.output("known_torque")[hips].any()
    walk.to(4.0 - PERIOD)
    walk.to(3.0 + 0.5 + STRIDE)
    assert walk.output("known_torque").any()


def test_a_command_is_added(exoskeleton: Exoskeleton) -> None:
    walk = Walk(exoskeleton)
    command = np.arange(42.0)
    exoskeleton.GetInputPort("command").FixValue(walk.context, command)
    walk.to(0.1)
    assert walk.output("torque") == pytest.approx(command)


def test_a_foot_that_stands_ends_the_assistance(exoskeleton: Exoskeleton) -> None:
    walk = Walk(exoskeleton)
    walk.to(3.45)
    assert walk.output("torque").any()
    exoskeleton.GetInputPort("foot_forces").FixValue(walk.context, loads(300.0, 300.0))
    walk.simulator.AdvanceTo(6.0)
    assert not walk.output("torque").any()


def test_a_bouncing_foot_does_not_begin_a_stride(exoskeleton: Exoskeleton) -> None:
    walk = Walk(exoskeleton)
    for _ in range(20):
        for load in (600.0, 0.0):
            exoskeleton.GetInputPort("foot_forces").FixValue(walk.context, loads(load, load))
            walk.simulator.AdvanceTo(walk.context.get_time() + PERIOD)
    assert not walk.output("torque").any()
