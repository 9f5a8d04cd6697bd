"""LeafSystem: the step planner in time."""

from dataclasses import dataclass
from typing import Self

from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import (
    BasicVector,
    Context,
    EventStatus,
    InputPort,
    LeafSystem,
    OutputPort,
    State,
)

from humanwalk.body import SIDES, Side
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.control.command import Command
from humanwalk.control.step_planner import PlannerState, StepPlanner, StepPlannerParameters
from humanwalk.control.walking_reference import (
    FootTask,
    Phase,
    WalkingReference,
    other,
)


@dataclass(frozen=True)
class Plan:
    """What a `GaitPlanner` remembers, and what it made of it; nothing before the simulation is initialised."""

    state: PlannerState | None = None
    reference: WalkingReference | None = None

    def __deepcopy__(self, memo: object) -> Self:
        """Itself: Drake copies abstract values often, and nothing in here ever changes."""
        return self


class GaitPlanner(LeafSystem):
    """Plans steps and balance, every control period.

    Planner and whole-body controller tick together. The planner ticks in an unrestricted update, which Drake does
    before the discrete updates of the same time: the controller works with the plan of now.

    Inputs:
        state: plant state [q; v].
        foot_forces: (16) see FootForceObserver.
        command: (3) forward and sideways speed [m/s], turn rate [rad/s].

    Outputs (all show state, so reading them plans nothing):
        plan: Plan, whose reference says what the body should do.
        phase: (2) of the right and left foot: 0 at touchdown, 1 at the next; 0 in standing.
        contact_schedule: (2) 1 where the right, the left foot should be on the ground.
        balance: (9) zero-moment point, DCM, its reference and the foothold, each x, y in W [m]; then the `Phase`.
    """

    def __init__(
        self, plant: MultibodyPlant, parameters: StepPlannerParameters, first_swing: Side, period: float
    ) -> None:
        """Make the planner.

        Args:
            plant: finalised model of the body, for kinematics only; stands straight by default.
            parameters: of the planner.
            first_swing: the foot that swings first.
            period: time between plans [s].
        """
        super().__init__()
        self._dynamics = BodyDynamics(plant)
        standing = plant.CreateDefaultContext()
        self._planner = StepPlanner(
            parameters,
            standing_com_height=plant.CalcCenterOfMassPositionInWorld(standing)[2],
            ankle_height=plant.GetFrameByName("RightLeg_Ankle").CalcPoseInWorld(standing).translation()[2],
            first_swing=first_swing,
            period=period,
        )
        self._step_duration = parameters.timing.step
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._command = self.DeclareVectorInputPort("command", 3)
        self._memory = self.DeclareAbstractState(Value(Plan()))
        needs = {self.abstract_state_ticket(self._memory)}
        self._plan_output = self.DeclareAbstractOutputPort(
            "plan", lambda: Value(Plan()), self._calc_plan, prerequisites_of_calc=needs
        )
        self._phase_output = self.DeclareVectorOutputPort("phase", 2, self._calc_phase, prerequisites_of_calc=needs)
        self._schedule_output = self.DeclareVectorOutputPort(
            "contact_schedule", 2, self._calc_schedule, prerequisites_of_calc=needs
        )
        self._balance_output = self.DeclareVectorOutputPort(
            "balance", 9, self._calc_balance, prerequisites_of_calc=needs
        )
        self.DeclareInitializationUnrestrictedUpdateEvent(self._start)
        self.DeclarePeriodicUnrestrictedUpdateEvent(period, 0.0, self._plan)

    def _start(self, context: Context, state: State) -> EventStatus:
        body = self._dynamics.body_state(self._state.Eval(context), context.get_time(), dict.fromkeys(SIDES, 0.0))
        plan = Plan(*self._planner.update(self._planner.start(body), body, Command()))
        state.get_mutable_abstract_state(int(self._memory)).set_value(plan)
        return EventStatus.Succeeded()

    def _plan(self, context: Context, state: State) -> EventStatus:
        forces = self._foot_forces.Eval(context)
        body = self._dynamics.body_state(
            self._state.Eval(context),
            context.get_time(),
            {side: float(forces[8 * place + 2]) for place, side in enumerate(SIDES)},
        )
        remembered = self._plan_in(context).state
        assert remembered is not None
        plan = Plan(*self._planner.update(remembered, body, Command(*self._command.Eval(context))))
        state.get_mutable_abstract_state(int(self._memory)).set_value(plan)
        return EventStatus.Succeeded()

    def _plan_in(self, context: Context) -> Plan:
        plan: Plan = context.get_abstract_state(int(self._memory)).get_value()
        return plan

    def _calc_plan(self, context: Context, output: Value) -> None:
        output.set_value(self._plan_in(context))

    def _calc_phase(self, context: Context, output: BasicVector) -> None:
        plan = self._plan_in(context)
        phases = dict.fromkeys(SIDES, 0.0)
        if plan.state and plan.reference and plan.reference.phase in (Phase.DOUBLE_SUPPORT, Phase.SINGLE_SUPPORT):
            share = min(0.5 * plan.reference.phase_time / self._step_duration, 0.5)
            phases = {plan.state.stance: share, other(plan.state.stance): share + 0.5}
        output.SetFromVector([phases[side] for side in SIDES])

    def _calc_schedule(self, context: Context, output: BasicVector) -> None:
        reference = self._plan_in(context).reference
        output.SetFromVector(
            [float(reference is None or reference.foot(side).task is not FootTask.SWING) for side in SIDES]
        )

    def _calc_balance(self, context: Context, output: BasicVector) -> None:
        reference = self._plan_in(context).reference
        if reference is None:
            output.SetZero()
            return
        points = (reference.zmp, reference.dcm, reference.dcm_reference, reference.foothold)
        output.SetFromVector([x for point in points for x in (point.real, point.imag)] + [reference.phase.value])

    def get_state_input_port(self) -> InputPort:
        """Input state."""
        return self._state

    def get_foot_forces_input_port(self) -> InputPort:
        """Input foot_forces."""
        return self._foot_forces

    def get_command_input_port(self) -> InputPort:
        """Input command."""
        return self._command

    def get_plan_output_port(self) -> OutputPort:
        """Output plan."""
        return self._plan_output

    def get_phase_output_port(self) -> OutputPort:
        """Output phase."""
        return self._phase_output

    def get_contact_schedule_output_port(self) -> OutputPort:
        """Output contact_schedule."""
        return self._schedule_output

    def get_balance_output_port(self) -> OutputPort:
        """Output balance."""
        return self._balance_output
