"""LeafSystem: the step planner, run periodically."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, EventStatus, LeafSystem, State

from humanwalk.body import SIDES, Side
from humanwalk.body.carried_load import NO_LOAD
from humanwalk.body.contact import SoleExtent
from humanwalk.body.hanging_arm import HangingArm
from humanwalk.body.upright import passive_ankles, upright
from humanwalk.contact.ground_force import FootForces
from humanwalk.systems.load_observer import load_at
from humanwalk.systems.signal import Signal
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.command import Command
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.planner_state import PlannerState
from humanwalk.walking.step_planner import StepPlanner
from humanwalk.walking.walking_reference import BodyState, FootTask, WalkingReference

POINTS = ("zmp", "dcm", "dcm_reference", "foothold")
"""Points of the reference in the output `balance`."""


class GaitPlanner(LeafSystem):
    """Plans steps and balance once per control period.

    Planner and whole-body controller share the period. The planner runs in an unrestricted update, which Drake
    performs before the discrete updates of the same time, so that the controller follows the current plan.

    Inputs:
        com, ankles: (6), (30) see BodyObserver.
        foot_forces: (16) see FootForceObserver.
        command: (3) forward and sideways speed [m/s], turn rate [rad/s].
        load: (4) load that the body carries in addition, see LoadObserver. Optional; default: none.

    Outputs (all of them are state; evaluating them does not plan):
        plan: WalkingReference, from initialization on.
        phase: (2) gait cycle of the right and left foot: 0 at touchdown, 1 at the next one; 0 in standing.
        contact_schedule: (2) 1 if the right, left foot should be on the ground, else 0.
        balance: (9) zero-moment point, DCM, its reference and the foothold, each x, y in W [m]; then the `Phase`.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        parameters: StepPlannerParameters,
        first_swing: Side,
        period: float,
        sole: SoleExtent,
        ground: Ground,
        arms: Mapping[Side, HangingArm],
    ) -> None:
        """Create the planner.

        Args:
            plant: Finalized model of the body, for kinematics only; upright with straight legs by default.
            parameters: Parameters of the planner.
            first_swing: The foot of the first step.
            period: Control period [s].
            sole: Extent of a sole.
            ground: What is known of the ground.
            arms: Both arms.
        """
        super().__init__()
        self._ground, self._arms = ground, arms
        standing = upright(plant)
        self._planner = StepPlanner(
            parameters,
            standing_com_height=standing.com_height,
            ankle_height=standing.ankle_height,
            leg_length=standing.leg_length,
            first_swing=first_swing,
            period=period,
            sole=sole,
            ground=ground,
            passive_ankles=passive_ankles(plant),
        )
        self._com = self.DeclareVectorInputPort("com", 6)
        self._ankles = self.DeclareVectorInputPort("ankles", 30)
        self._foot_forces = self.DeclareVectorInputPort("foot_forces", 16)
        self._command = self.DeclareVectorInputPort("command", 3)
        self._load = self.DeclareVectorInputPort("load", NO_LOAD.size)
        self._memory = self.DeclareAbstractState(Value[object]())
        self._reference = self.DeclareAbstractState(Value[object]())
        self.DeclareStateOutputPort("plan", self._reference)
        self._phase = self.DeclareDiscreteState(2)
        self._schedule = self.DeclareDiscreteState(np.ones(2))
        self._balance = self.DeclareDiscreteState(9)
        feet = [f"{side.lower()}_foot" for side in SIDES]
        points = [f"{point}.{axis}_m" for point in POINTS for axis in "xy"]
        self.signals = tuple(
            Signal(name, self.DeclareStateOutputPort(name, index), columns)
            for name, index, columns in (
                ("phase", self._phase, tuple(f"{foot}.phase" for foot in feet)),
                ("contact_schedule", self._schedule, tuple(f"{foot}.scheduled" for foot in feet)),
                ("balance", self._balance, (*points, "planner.phase")),
            )
        )
        self.DeclareInitializationUnrestrictedUpdateEvent(self._start)
        self.DeclarePeriodicUnrestrictedUpdateEvent(period, 0.0, self._plan)

    def _start(self, context: Context, state: State) -> EventStatus:
        body = self._body(context, self._ground)
        return self._store(state, *self._planner.update(self._planner.start(body), body, Command()))

    def _plan(self, context: Context, state: State) -> EventStatus:
        memory = context.get_abstract_state(int(self._memory)).get_value()
        command = Command(*self._command.Eval(context).tolist())
        return self._store(state, *self._planner.update(memory, self._body(context, memory.ground), command))

    def _body(self, context: Context, ground: Ground) -> BodyState:
        ankles = self._ankles.Eval(context).reshape(2, 5, 3)
        forces = FootForces.of(self._foot_forces.Eval(context))
        load = load_at(self._load, context)
        body = BodyState.measured(self._com.Eval(context), ankles, forces, ground)
        right, left = (self._arms[side].freedom(load) for side in SIDES)
        return replace(body, arm_freedom=(right, left))

    def _store(self, state: State, memory: PlannerState, reference: WalkingReference) -> EventStatus:
        state.get_mutable_abstract_state(int(self._memory)).set_value(memory)
        state.get_mutable_abstract_state(int(self._reference)).set_value(reference)
        for group, values in (
            (self._phase, [reference.gait_phase(side) for side in SIDES]),
            (self._schedule, [float(reference.foot(side).task is not FootTask.SWING) for side in SIDES]),
            (self._balance, _balance(reference)),
        ):
            state.get_mutable_discrete_state(group).SetFromVector(values)
        return EventStatus.Succeeded()


def _balance(reference: WalkingReference) -> list[float]:
    points = (getattr(reference, name) for name in POINTS)
    return [*(x for point in points for x in (point.real, point.imag)), reference.phase.value]
