"""The actuation of the joints: how a command becomes torque."""

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex

from humanwalk.body.joint_map import JointMap
from humanwalk.choices.world import World
from humanwalk.control.pd_control import PD_LAWS, PdLaw, install_gains
from humanwalk.numerics import Array
from humanwalk.systems.pd_actuator_bank import PdActuatorBank


class Actuation(Protocol):
    """One way to drive the joints."""

    def install(self, plant: MultibodyPlant, kp: Array, kd: Array) -> None:
        """Give a plant that is not finalized what the law leaves to its solver; gains in actuator order, (n,)."""

    def step_impedance(self, step: float, kp: Array, kd: Array) -> tuple[Array, Array]:
        """The law's `StepImpedance` with these gains, shape (n,) each."""

    def add_to(self, world: World) -> None:
        """Add the system `actuators`, whose inputs are those of `PdActuatorBank`, and connect it with the plant.

        The inputs that a `Command` has are connected later.

        Raises:
            ParameterError: the law is not stable at the plant's time step.
        """


@dataclass(frozen=True)
class PdActuation:
    """A PD controller for every joint (thesis Eq 4-23)."""

    law: PdLaw = "semi_implicit"
    """How the plant is given the law; see `PD_LAWS`."""

    effort_limits: Literal["human", "none"] = "human"
    """Saturate at the body's effort limits, or at nothing, as in the thesis."""

    def install(self, plant: MultibodyPlant, kp: Array, kd: Array) -> None:
        if self.effort_limits == "none":
            for i in range(plant.num_actuators()):
                plant.get_mutable_joint_actuator(JointActuatorIndex(i)).set_effort_limit(np.inf)
        install_gains(plant, kp, kd, self.law)

    def step_impedance(self, step: float, kp: Array, kd: Array) -> tuple[Array, Array]:
        return PD_LAWS[self.law].impedance(step, kp, kd)

    def add_to(self, world: World) -> None:
        plant, builder = world.plant, world.builder
        limits = JointMap.of(world.model).effort_limits
        if self.effort_limits == "none":
            limits = np.full_like(limits, np.inf)
        bank = world.add(
            "actuators",
            PdActuatorBank(plant, world.kp, world.kd, self.law, limits),
            state=world.state,
            net_actuation=plant.get_net_actuation_output_port(),
        )
        builder.Connect(bank.GetOutputPort("actuation"), plant.get_actuation_input_port())
        if PD_LAWS[self.law].takes_desired_state:
            builder.Connect(
                bank.GetOutputPort("plant_desired_state"), plant.get_desired_state_input_port(world.instance)
            )


ACTUATIONS: dict[str, type[Actuation]] = {"pd": PdActuation}
"""The actuations that a scenario can name."""
