"""The assumed balance, added for controllers that do not balance."""

from pydrake.systems.framework import OutputPort

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.choices.world import World
from humanwalk.control.balance_support import BalanceSupportParameters, largest_support_step
from humanwalk.numerics.stability import round_down
from humanwalk.quantity import ParameterError
from humanwalk.systems.balance_support import BalanceSupport


def add_support(world: World, parameters: BalanceSupportParameters, pelvis_reference: OutputPort) -> None:
    """Add `support`, unless it is disabled.

    Args:
        world: Where it acts.
        parameters: Of the support, in the units of the subject's body.
        pelvis_reference: Port of what the pelvis should do.

    Raises:
        ParameterError: the support, an explicit force, is not stable at the plant's step.
    """
    if not parameters.enabled:
        return
    plant = world.plant
    M = base_first_mass_matrix(plant)
    stable = largest_support_step(M, world.kp, world.step_impedance, parameters)
    if plant.time_step() > stable:
        raise ParameterError(
            f"support: unstable at time_step {plant.time_step():g} s; allowed: steps up to {round_down(stable):g} s "
            "with this stiffness and damping; lower simulation.time_step, or rotational_damping and damping"
        )
    support = world.add(
        "support", BalanceSupport(plant, parameters), pelvis_reference=pelvis_reference, state=world.state
    )
    world.generalized_forces.append(support.GetOutputPort("generalized_force"))
