"""LeafSystem: the torques of exoskeletons over the gait cycle."""

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, DiscreteValues, EventStatus, LeafSystem

from humanwalk.body import SIDES
from humanwalk.body.devices import Assistance
from humanwalk.body.joint_map import JointMap
from humanwalk.contact.ground_force import FootForces
from humanwalk.numerics import Array
from humanwalk.systems.signal import Signal

TOUCHDOWN_FORCE = 50.0
"""Vertical force at which a heel switch closes [N] (our choice)."""

MIN_STRIDE, MAX_STRIDE = 0.5, 2.5
"""Shortest and longest stride [s]; a shorter one is the foot's bouncing, a longer one ends the assistance."""

NEVER = -1e3
"""Time of a touchdown before the walk [s]."""


class Exoskeleton(LeafSystem):
    """Torques on joints over the gait cycle of each foot, which the device finds from touchdown to touchdown.

    Both feet stand at the start. The phase of a foot is the time since its last touchdown over the duration of its last
    stride. There is no torque before the second touchdown, after the end of the cycle, and while a stride has no
    ordinary duration.

    Inputs:
        foot_forces: (16) see FootForceObserver.
        command: (n) torque on the joints that is added to the profiles, in actuator order [N m]. Optional; default:
            zero. The diagram exports it as `exoskeleton_command`.

    Outputs, n joints in actuator order:
        torque: (n) torque of all devices on the joints [N m].
        known_torque: (n) of it the profiles that the walker's model includes [N m].
        generalized_force: (nv) the same as `torque`, for the plant's applied_generalized_force port [N m].
    """

    def __init__(self, plant: MultibodyPlant, assistance: Sequence[Assistance], period: float) -> None:
        """Make the exoskeleton.

        Args:
            plant: finalized plant of the body.
            assistance: torques over the gait cycle.
            period: time between two readings of the heel switches [s].
        """
        super().__init__()
        joints = JointMap.of(plant)
        self._v, n = joints.v, len(joints.names)
        self._assistance = [(joints.names.index(a.joint), SIDES.index(a.side), a) for a in assistance]
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._command = self.DeclareVectorInputPort("command", n)
        # Of each foot: whether it is loaded, time of the last touchdown, duration of the last stride; 0 for none.
        self._switches = self.DeclareDiscreteState(np.array([(1.0, NEVER, 0.0)] * len(SIDES)).ravel())
        self._torque = self.DeclareVectorOutputPort("torque", n, self._calc_torque)
        self.DeclareVectorOutputPort("known_torque", n, self._calc_known)
        self.DeclareVectorOutputPort("generalized_force", plant.num_velocities(), self._calc_generalized)
        columns = tuple(f"{name}.exoskeleton_torque_N_m" for name in joints.names)
        self.signals = (Signal("exoskeleton_torque", self._torque, columns),)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._read_switches)

    def _read_switches(self, context: Context, discrete_state: DiscreteValues) -> EventStatus:
        time = context.get_time()
        loads = FootForces.of(self._foot_forces.Eval(context)).f_W[:, 2]
        feet = context.get_discrete_state(self._switches).value().reshape(2, 3).copy()
        for foot, load in zip(feet, loads, strict=True):
            was_loaded, touchdown, _ = foot
            foot[0] = load > TOUCHDOWN_FORCE
            if foot[0] > was_loaded and time - touchdown > MIN_STRIDE:
                stride = time - touchdown
                foot[1:] = time, stride if stride < MAX_STRIDE else 0.0
        discrete_state.set_value(self._switches, feet.ravel())
        return EventStatus.Succeeded()

    def _profiles(self, context: Context, known_only: bool) -> Array:
        """Torque of the profiles [N m], shape (n,)."""
        torque = np.zeros(self._v.size)
        feet = context.get_discrete_state(self._switches).value().reshape(2, 3)
        for joint, foot, assistance in self._assistance:
            _, touchdown, stride = feet[foot]
            if stride > 0.0 and context.get_time() - touchdown < stride and (assistance.known or not known_only):
                torque[joint] += assistance.torque((context.get_time() - touchdown) / stride)
        return torque

    def _calc_known(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._profiles(context, known_only=True))

    def _calc_torque(self, context: Context, output: BasicVector) -> None:
        added = self._command.Eval(context) if self._command.HasValue(context) else 0.0
        output.SetFromVector(self._profiles(context, known_only=False) + added)

    def _calc_generalized(self, context: Context, output: BasicVector) -> None:
        force = np.zeros(output.size())
        force[self._v] = self._torque.Eval(context)
        output.SetFromVector(force)
