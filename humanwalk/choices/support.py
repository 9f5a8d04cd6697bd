"""The assumed balance, added for controllers that do not balance."""

from pydrake.systems.framework import OutputPort

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.body.subject import Subject
from humanwalk.choices.world import World
from humanwalk.control.balance_support import BalanceSupportParameters, largest_support_step
from humanwalk.numerics.stability import round_down
from humanwalk.quantity import ParameterError
from humanwalk.systems.balance_support import BalanceSupport


def add_support(world: World, parameters: BalanceSupportParameters, pelvis_reference: OutputPort) -> None:
    """Add `support`, scaled to the subject, unless it is disabled.

    Raises:
        ParameterError: the support, an explicit force, is not stable at the plant's step.
    """
    if not parameters.enabled:
        return
    plant, subject, reference = world.plant, world.subject, Subject()
    scaled = parameters.scaled(subject.known_mass / reference.mass, subject.stature / reference.stature)
    M = base_first_mass_matrix(plant, plant.CreateDefaultContext())
    stable = largest_support_step(M, world.kp, world.step_impedance, scaled)
    if plant.time_step() > stable:
        raise ParameterError(
            f"support: unstable at time_step {plant.time_step():g} s; allowed: steps up to {round_down(stable):g} s "
            "with this stiffness and damping; lower simulation.time_step, or rotational_damping and damping"
        )
    support = world.add("support", BalanceSupport(plant, scaled), pelvis_reference=pelvis_reference, state=world.state)
    world.builder.Connect(support.GetOutputPort("generalized_force"), plant.get_applied_generalized_force_input_port())
