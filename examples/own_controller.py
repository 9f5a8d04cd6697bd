"""A controller of your own beside the PD bank: ankles that push off harder while they carry load.

It reads the force on the feet and adds torque through the walker's input port `feedforward`.
Run it with: python examples/own_controller.py
"""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, LeafSystem

from humanwalk import load_scenario, make_walker
from humanwalk.body.joint_map import JointMap


class AnklePush(LeafSystem):
    """Plantarflexion torque in proportion to the load on the foot.

    Inputs:
        foot_forces: (16) see FootForceObserver.

    Outputs:
        feedforward: (n) torque of every joint, in actuator order [N m].
    """

    def __init__(self, joint_names: tuple[str, ...], lever: float) -> None:
        """Make it for n joints; lever: torque by vertical force [m]."""
        super().__init__()
        self._lever = lever
        self._ankles = [joint_names.index(f"{side}LegAnkleMotion") for side in ("Right", "Left")]
        self._forces = self.DeclareVectorInputPort("foot_forces", 16)
        # Contact forces answer torques: a sampled torque breaks the circle, as a real controller's clock does.
        torque = self.DeclareDiscreteState(len(joint_names))
        self.DeclarePeriodicDiscreteUpdateEvent(0.005, 0.0, self._update)
        self.DeclareStateOutputPort("feedforward", torque)

    def _update(self, context: Context, discrete: BasicVector) -> None:
        forces = self._forces.Eval(context).reshape(2, 8)
        torque = np.zeros(discrete.get_vector().size())
        # Dorsiflexion is positive.
        torque[self._ankles] = -self._lever * forces[:, 2]
        discrete.set_value(torque)


def main(duration: float = 2.0, lever: float = 0.02) -> float:
    """Walk for some seconds [s] and return how far the pelvis came [m]."""
    builder = DiagramBuilder()
    walker = builder.AddNamedSystem("walker", make_walker(load_scenario("thesis")))
    plant = walker.GetSubsystemByName("plant")
    assert isinstance(plant, MultibodyPlant)
    push = builder.AddNamedSystem("ankle_push", AnklePush(JointMap.of(plant).names, lever))
    builder.Connect(walker.GetOutputPort("foot_forces"), push.GetInputPort("foot_forces"))
    builder.Connect(push.GetOutputPort("feedforward"), walker.GetInputPort("feedforward"))
    diagram = builder.Build()

    simulator = Simulator(diagram)
    simulator.AdvanceTo(duration)
    context = walker.GetMyContextFromRoot(simulator.get_context())
    pelvis = walker.GetOutputPort("state").Eval(context)[4:7]
    print(f"The pelvis is at {np.round(pelvis, 3)} m after {duration:g} s.")
    return float(pelvis[0])


if __name__ == "__main__":
    main()
