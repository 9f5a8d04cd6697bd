"""LeafSystem: desired joint angles between two solutions of the inverse kinematics."""

from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.control.hermite import hermite


class PostureInterpolator(LeafSystem):
    """Cubic Hermite interpolation of the desired state from the previous sample to the next, see `hermite`.

    Inputs:
        previous_state, next_state: (2n) desired angles [rad], then rates [rad/s], at two times.
        previous_time, next_time: (1) the times [s].

    Outputs:
        desired_state: (2n) the desired state now; its rates are the time derivatives of its angles.
    """

    def __init__(self, num_joints: int) -> None:
        """Make the interpolator for n joints."""
        super().__init__()
        self._previous_state = self.DeclareVectorInputPort("previous_state", 2 * num_joints)
        self._previous_time = self.DeclareVectorInputPort("previous_time", 1)
        self._next_state = self.DeclareVectorInputPort("next_state", 2 * num_joints)
        self._next_time = self.DeclareVectorInputPort("next_time", 1)
        self.DeclareVectorOutputPort("desired_state", 2 * num_joints, self._calc)

    def _calc(self, context: Context, output: BasicVector) -> None:
        (t0,), (t1,) = self._previous_time.Eval(context), self._next_time.Eval(context)
        x0, x1 = self._previous_state.Eval(context), self._next_state.Eval(context)
        output.SetFromVector(hermite(context.get_time(), t0, x0, t1, x1))
