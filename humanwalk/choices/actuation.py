"""The actuation of the joints: how a command becomes torque."""

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex

from humanwalk.body.joint_map import JointMap, base_first_mass_matrix
from humanwalk.body.plant import body_plant
from humanwalk.body_units import scaled
from humanwalk.choices.world import World
from humanwalk.control.adaptive_feedforward import AdaptationParameters, require_passive
from humanwalk.control.integral_action import require_stable_integral
from humanwalk.control.pd_control import PD_LAWS, PdLaw, install_gains
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError, quantity, tag_of
from humanwalk.systems.adaptive_feedforward import AdaptiveFeedforward
from humanwalk.systems.integral_action import IntegralAction
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
        limits = JointMap.of(body_plant(world.subject)).effort_limits
        if self.effort_limits == "none":
            limits = np.full_like(limits, np.inf)
        try:
            bank = world.add(
                "actuators",
                PdActuatorBank(plant, world.kp, world.kd, self.law, limits),
                state=world.state,
                net_actuation=plant.get_net_actuation_output_port(),
            )
            self.add_correction(world)
        except ParameterError as error:
            raise ParameterError(f"actuation.{tag_of(ACTUATIONS, self)}.{error}") from None
        builder.Connect(bank.GetOutputPort("actuation"), plant.get_actuation_input_port())
        if PD_LAWS[self.law].takes_desired_state:
            builder.Connect(
                bank.GetOutputPort("plant_desired_state"), plant.get_desired_state_input_port(world.instance)
            )

    def add_correction(self, world: World) -> None:
        """Add and connect the system that corrects the PD law of `actuators`; the PD law alone has none.

        Raises:
            ParameterError: the correction is not possible; the message begins with the name of a field.
        """


@dataclass(frozen=True)
class PidActuation(PdActuation):
    """A PID controller for every joint: the PD law and an integral of the angle error that stops at the effort limits.

    The time is for the reference body and scales with the subject.

    Joints without stiffness have no integral action either: those that the balanced controller moves by torque.
    """

    integral_time: float = quantity(1.0, "s", 0.01, 100.0)
    """T_i = kp / ki: under a constant error the integral torque rises by the torque of the stiffness in this time.
    Longer than a gait cycle (0.6 s in the thesis' walk): shorter times amplify the periodic error."""

    def add_correction(self, world: World) -> None:
        time = scaled(self, world.subject.scale).integral_time
        require_stable_integral(world.plant, world.kp, world.kd, self.law, "integral_time", time)
        _add_correction(world, "integral_action", IntegralAction(world.plant, world.kp / time))


@dataclass(frozen=True)
class AdaptiveActuation(PdActuation, AdaptationParameters):
    """The PD law and a feedforward of the estimated inertia and load of every joint (Slotine and Li, 1987).

    Times and rates are for the reference body and scale with the subject.

    Joints without stiffness do not adapt: those that the balanced controller moves by torque.
    """

    def add_correction(self, world: World) -> None:
        plant, kp, kd, own = world.plant, world.kp, world.kd, scaled(self, world.subject.scale)
        neutral = body_plant(world.subject)
        inertia = base_first_mass_matrix(neutral).diagonal()[-kp.size :]
        require_passive(kd, inertia, kp > 0, own.error_rate)
        # At a constant acceleration the adaptation is integral action, to which inertia and load each add up to kp / T.
        require_stable_integral(
            plant, kp, kd, self.law, "adaptation_time", own.adaptation_time, gain=2.0, rate_time=1.0 / own.error_rate
        )
        # Also where the actuators have no limits: no joint of a person carries more.
        max_load = JointMap.of(world.model).effort_limits
        _add_correction(world, "adaptive_feedforward", AdaptiveFeedforward(plant, kp, inertia, max_load, own))


def _add_correction(world: World, name: str, system: IntegralAction | AdaptiveFeedforward) -> None:
    """Add a system between the desired state of `actuators` and its correction."""
    world.add(
        name,
        system,
        desired_state=world.port("actuators", "held_desired_state"),
        saturated=world.port("actuators", "saturated"),
        state=world.state,
    )
    bank = world.builder.GetSubsystemByName("actuators")
    world.builder.Connect(system.GetOutputPort("torque"), bank.GetInputPort("correction"))


ACTUATIONS: dict[str, type[Actuation]] = {"pd": PdActuation, "pid": PidActuation, "adaptive": AdaptiveActuation}
"""The actuations that a scenario can name."""
