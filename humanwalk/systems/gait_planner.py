"""LeafSystem: the step planner in time."""

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import (
    Context,
    EventStatus,
    LeafSystem,
    State,
)

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import LEGS
from humanwalk.control.body_dynamics import BodyDynamics
from humanwalk.terrain.terrain import Terrain
from humanwalk.walking.command import Command
from humanwalk.walking.step_planner import PlannerState, StepPlanner, StepPlannerParameters
from humanwalk.walking.walking_reference import (
    BodyState,
    FootTask,
    Phase,
    WalkingReference,
    other,
)


class GaitPlanner(LeafSystem):
    """Plans steps and balance, every control period.

    Planner and whole-body controller tick together. The planner ticks in an unrestricted update, which Drake does
    before the discrete updates of the same time: the controller works with the plan of now.

    Inputs:
        state: plant state [q; v].
        foot_forces: (16) see FootForceObserver.
        command: (3) forward and sideways speed [m/s], turn rate [rad/s].

    Outputs (all show state, so reading them plans nothing):
        plan: WalkingReference, from initialization on.
        phase: (2) of the right and left foot: 0 at touchdown, 1 at the next; 0 in standing.
        contact_schedule: (2) 1 where the right, the left foot should be on the ground.
        balance: (9) zero-moment point, DCM, its reference and the foothold, each x, y in W [m]; then the `Phase`.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        parameters: StepPlannerParameters,
        first_swing: Side,
        period: float,
        terrain: Terrain,
    ) -> None:
        """Make the planner.

        Args:
            plant: finalised model of the body, for kinematics only; stands straight by default.
            parameters: of the planner.
            first_swing: the foot that swings first.
            period: time between plans [s].
            terrain: on which the body walks.
        """
        super().__init__()
        self._dynamics = BodyDynamics(plant)
        standing = plant.CreateDefaultContext()
        leg = LEGS["Right"]
        hip, ankle, sole = (
            float(plant.GetFrameByName(frame).CalcPoseInWorld(standing).translation()[2])
            for frame in (leg.thigh, leg.hindfoot, leg.sole)
        )
        self._planner = StepPlanner(
            parameters,
            standing_com_height=float(plant.CalcCenterOfMassPositionInWorld(standing)[2]) - sole,
            ankle_height=ankle - sole,
            leg_length=hip - ankle,
            first_swing=first_swing,
            period=period,
            terrain=terrain,
        )
        self._step_duration = parameters.timing.step
        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._command = self.DeclareVectorInputPort("command", 3)
        self._memory = self.DeclareAbstractState(Value[object]())
        self._reference = self.DeclareAbstractState(Value[object]())
        phase = self.DeclareDiscreteState(2)
        schedule = self.DeclareDiscreteState(np.ones(2))
        balance = self.DeclareDiscreteState(9)
        self._shown = (phase, schedule, balance)
        self._plan_output = self.DeclareStateOutputPort("plan", self._reference)
        self._phase_output = self.DeclareStateOutputPort("phase", phase)
        self._schedule_output = self.DeclareStateOutputPort("contact_schedule", schedule)
        self._balance_output = self.DeclareStateOutputPort("balance", balance)
        self.DeclareInitializationUnrestrictedUpdateEvent(self._start)
        self.DeclarePeriodicUnrestrictedUpdateEvent(period, 0.0, self._plan)

    def _start(self, context: Context, state: State) -> EventStatus:
        body = self._body(context)
        return self._remember(state, *self._planner.update(self._planner.start(body), body, Command()))

    def _plan(self, context: Context, state: State) -> EventStatus:
        remembered = context.get_abstract_state(int(self._memory)).get_value()
        body = self._body(context)
        command = Command(*self._command.Eval(context).tolist())
        return self._remember(state, *self._planner.update(remembered, body, command))

    def _body(self, context: Context) -> BodyState:
        forces = self._foot_forces.Eval(context)
        vertical = {side: float(forces[8 * place + 2]) for place, side in enumerate(SIDES)}
        return self._dynamics.body_state(self._state.Eval(context), context.get_time(), vertical)

    def _remember(self, state: State, planned: PlannerState, reference: WalkingReference) -> EventStatus:
        state.get_mutable_abstract_state(int(self._memory)).set_value(planned)
        state.get_mutable_abstract_state(int(self._reference)).set_value(reference)
        shown = (self._phases(planned, reference), _schedule(reference), _balance(reference))
        for group, values in zip(self._shown, shown, strict=True):
            state.get_mutable_discrete_state(group).SetFromVector(values)
        return EventStatus.Succeeded()

    def _phases(self, planned: PlannerState, reference: WalkingReference) -> list[float]:
        phases = dict.fromkeys(SIDES, 0.0)
        if reference.phase in (Phase.DOUBLE_SUPPORT, Phase.SINGLE_SUPPORT):
            share = min(0.5 * reference.phase_time / self._step_duration, 0.5)
            phases = {planned.stance: share, other(planned.stance): share + 0.5}
        return [phases[side] for side in SIDES]


def _schedule(reference: WalkingReference) -> list[float]:
    return [float(reference.foot(side).task is not FootTask.SWING) for side in SIDES]


def _balance(reference: WalkingReference) -> list[float]:
    points = (reference.zmp, reference.dcm, reference.dcm_reference, reference.foothold)
    return [*(x for point in points for x in (point.real, point.imag)), reference.phase.value]
