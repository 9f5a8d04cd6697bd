"""A rig for systems that correct the PD law: one joint with its actuator bank."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, MultibodyPlant
from pydrake.multibody.tree import RevoluteJoint, SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder, System
from pydrake.systems.primitives import ConstantVectorSource, LogVectorOutput, Multiplexer, Sine

from humanwalk.body.plant import add_human
from humanwalk.body.subject import Subject
from humanwalk.control.pd_control import PdLaw, install_gains
from humanwalk.numerics import Array
from humanwalk.systems.pd_actuator_bank import PdActuatorBank

KP, KD, INERTIA = 100.0, 10.0, 0.5
TIME_STEP = 0.002


@dataclass
class Rig:
    """A wheel on a vertical axis, driven by a bank with a correction, under a constant load.

    Attributes:
        plant: of the wheel, 0.5 kg m2.
        correction: the system that corrects the law.
        simulator: of the diagram.
        sinks: logs of angle and rate, actuation, and the outputs of the correction.
    """

    plant: MultibodyPlant
    correction: Any
    simulator: Simulator
    sinks: list[Any]

    @property
    def context(self) -> Context:
        return self.simulator.get_context()

    @property
    def angle(self) -> float:
        return float(self.plant.GetPositions(self.plant.GetMyContextFromRoot(self.context))[0])

    @property
    def logged(self) -> Array:
        """Angle, rate, actuation and the correction's outputs in every step, a row each."""
        return np.concatenate([sink.FindLog(self.context).data() for sink in self.sinks])

    def output(self, name: str) -> Array:
        value: Array = self.correction.GetOutputPort(name).Eval(self.correction.GetMyContextFromRoot(self.context))
        return value.copy()


def make_rig(
    correction: Callable[[MultibodyPlant], System] | None,
    target: float | tuple[float, float] = 0.0,
    load: float = 0.0,
    limit: float = np.inf,
    law: PdLaw = "semi_implicit",
    time_step: float = TIME_STEP,
    reports_saturation: bool = True,
) -> Rig:
    """Make the rig.

    Args:
        correction: makes the system from the plant; None: PD alone.
        target: angle of the wheel, or amplitude and angular frequency of a cosine.
        load: torque against the joint [N m].
        limit: effort limit [N m].
        law: discretization of the PD law.
        time_step: of the plant [s].
        reports_saturation: whether the correction receives the bank's `saturated`, or always 0.
    """
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step)
    wheel = plant.AddRigidBody("wheel", SpatialInertia(1.0, np.zeros(3), UnitInertia(INERTIA, INERTIA, INERTIA)))
    joint = plant.AddJoint(RevoluteJoint("axle", plant.world_frame(), wheel.body_frame(), [0, 0, 1]))
    plant.AddJointActuator("motor", joint, limit)
    kp, kd = np.array([KP]), np.array([KD])
    install_gains(plant, kp, kd, law)
    plant.Finalize()
    limits = np.array([limit])
    bank = builder.AddSystem(PdActuatorBank(plant, kp, kd, law, limits))
    if isinstance(target, tuple):
        amplitude, frequency = target
        wave = builder.AddSystem(Sine([amplitude], [frequency], [np.pi / 2]))
        desired: System = builder.AddSystem(Multiplexer([1, 1]))
        for i in range(2):
            builder.Connect(wave.get_output_port(i), desired.get_input_port(i))
    else:
        desired = builder.AddSystem(ConstantVectorSource([target, 0.0]))
    against = builder.AddSystem(ConstantVectorSource([-load]))
    for port, source in (
        ("desired_state", desired.get_output_port(0)),
        ("state", plant.get_state_output_port()),
        ("net_actuation", plant.get_net_actuation_output_port()),
    ):
        builder.Connect(source, bank.GetInputPort(port))
    builder.Connect(against.get_output_port(), plant.get_applied_generalized_force_input_port())
    builder.Connect(bank.GetOutputPort("actuation"), plant.get_actuation_input_port())
    if bank.HasOutputPort("plant_desired_state"):
        instance = wheel.model_instance()
        builder.Connect(bank.GetOutputPort("plant_desired_state"), plant.get_desired_state_input_port(instance))
    logged = [plant.get_state_output_port(), plant.get_net_actuation_output_port()]
    system = None
    if correction is not None:
        system = builder.AddSystem(correction(plant))
        builder.Connect(bank.GetOutputPort("held_desired_state"), system.GetInputPort("desired_state"))
        never = builder.AddSystem(ConstantVectorSource([0.0]))
        saturated = bank.GetOutputPort("saturated") if reports_saturation else never.get_output_port()
        builder.Connect(saturated, system.GetInputPort("saturated"))
        builder.Connect(plant.get_state_output_port(), system.GetInputPort("state"))
        builder.Connect(system.GetOutputPort("torque"), bank.GetInputPort("correction"))
        logged += map(system.get_output_port, range(system.num_output_ports()))
    sinks = [LogVectorOutput(port, builder, time_step) for port in logged]
    return Rig(plant, system, Simulator(builder.Build()), sinks)


@pytest.fixture(scope="session")
def discrete_plant() -> MultibodyPlant:
    """The human with the step of the rig."""
    plant = MultibodyPlant(TIME_STEP)
    add_human(plant, Subject())
    plant.Finalize()
    return plant


@pytest.fixture(scope="session")
def rig() -> Callable[..., Rig]:
    """Makes rigs, see `make_rig`."""
    return make_rig
