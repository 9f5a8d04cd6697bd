"""LeafSystem: desired joint angles between two solutions of the inverse kinematics."""

from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector, Context, LeafSystem, ValueProducer

from humanwalk.control.hermite import HermitePiece


class PostureInterpolator(LeafSystem):
    """Cubic Hermite interpolation of the desired state from the previous sample to the next.

    Outside the two samples it goes on with the rate of the nearer one.

    Inputs:
        previous_state, next_state: (2n) desired angles [rad], then rates [rad/s], at two times.
        previous_time, next_time: (1) the times [s].

    Outputs:
        desired_state: (2n) the desired state of now; its rates are the time derivatives of its angles.
    """

    def __init__(self, num_joints: int) -> None:
        """Make the interpolator for n joints."""
        super().__init__()
        self._inputs = {
            name: self.DeclareVectorInputPort(name, size)
            for name, size in (
                ("previous_state", 2 * num_joints),
                ("previous_time", 1),
                ("next_state", 2 * num_joints),
                ("next_time", 1),
            )
        }
        # Samples come ten times as seldom as the plant asks.
        self._piece = self.DeclareCacheEntry(
            "piece",
            ValueProducer(allocate=lambda: Value(object()), calc=self._calc_piece),
            prerequisites_of_calc={self.all_input_ports_ticket()},
        )
        self._output = self.DeclareVectorOutputPort(
            "desired_state",
            2 * num_joints,
            self._calc,
            prerequisites_of_calc={self.time_ticket(), self._piece.ticket()},
        )

    def _calc_piece(self, context: Context, piece: Value) -> None:
        previous, t0, following, t1 = (port.Eval(context) for port in self._inputs.values())
        piece.set_value(HermitePiece.between(t0[0], previous, t1[0], following))

    def _calc(self, context: Context, output: BasicVector) -> None:
        piece: HermitePiece = self._piece.Eval(context)
        output.SetFromVector(piece.at(context.get_time()))
