"""The thesis' controller: foot paths by splines, inverse kinematics of the legs, assumed balance."""

from dataclasses import dataclass
from typing import Any, Literal

from pydrake.systems.framework import OutputPort

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.body_units import scaled
from humanwalk.choices.controller import JointCommand
from humanwalk.choices.start import StartPosture, start_slope
from humanwalk.choices.support import add_support
from humanwalk.choices.world import World
from humanwalk.control.balance_levels import FootForceBalanceParameters, UpperBodyBalanceParameters
from humanwalk.control.balance_support import BalanceSupportParameters
from humanwalk.control.inverse_kinematics import InverseKinematicsParameters
from humanwalk.control.joint_gains import JointGains, joint_gains
from humanwalk.control.reach import require_reachable, require_reachable_on
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY, ParameterError, quantity
from humanwalk.sides import SIDES
from humanwalk.systems.arm_swing_source import ArmSwingSource
from humanwalk.systems.foot_force_balance import FootForceBalance
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver
from humanwalk.systems.posture_interpolator import PostureInterpolator
from humanwalk.systems.upper_body_balance import UpperBodyBalance
from humanwalk.terrain import Terrain
from humanwalk.walking.arm_swing import ArmSwingParameters, arm_joints
from humanwalk.walking.footholds import FootholdSearch
from humanwalk.walking.gait_on_ground import GaitOnGround
from humanwalk.walking.swing_clearance import ClearanceParameters


@dataclass(frozen=True)
class GaitParameters:
    """The walk that is commanded."""

    ramp: SpeedRamp = SpeedRamp()
    """Speed of the pelvis over time."""

    path: FootPathParameters = FootPathParameters()
    """Path of each foot."""

    first_swing: Literal["Right", "Left"] = "Right"
    """Leg that swings first."""

    footholds: FootholdSearch = FootholdSearch(max_overhang=0.086)
    """Where the feet stand on ground that is not level; `same_face` has no effect, since no foothold changes. A third
    of the reference sole may protrude (our choice), since the body is held."""

    clearance: ClearanceParameters = ClearanceParameters()
    """How the feet clear such ground; `hold` has no effect, since no foot corrects its place."""

    arms: ArmSwingParameters = ArmSwingParameters()
    """Swing of the arms."""


@dataclass(frozen=True)
class BalanceParameters:
    """What keeps the body upright; values are for the reference body and scale with the subject."""

    support: BalanceSupportParameters = BalanceSupportParameters()
    """The assumed balance: a spring-damper on the pelvis."""

    foot_force: FootForceBalanceParameters = FootForceBalanceParameters()
    """Level 1 of the thesis."""

    upper_body: UpperBodyBalanceParameters = UpperBodyBalanceParameters()
    """Level 2 of the thesis."""


@dataclass(frozen=True)
class ThesisController:
    """Spline source, inverse kinematics and, between them, the thesis' two balance levels."""

    gait: GaitParameters = GaitParameters()
    inverse_kinematics: InverseKinematicsParameters = InverseKinematicsParameters()
    balance: BalanceParameters = BalanceParameters()
    gains: JointGains = JointGains()

    control_period: float = quantity(0.01, "s", 0.0005, 0.05)
    """Time between two solutions of the inverse kinematics; 0.01 s is the thesis' time between two foot points."""

    physics = True
    command = followed_style = None

    def __post_init__(self) -> None:
        """Raise ParameterError for a lag of a balance level that its time steps cannot follow: it would diverge."""
        levels: dict[str, FootForceBalanceParameters | UpperBodyBalanceParameters] = {
            "foot_force": self.balance.foot_force,
            "upper_body": self.balance.upper_body,
        }
        for name, level in levels.items():
            if level.enabled and level.time_constant < self.control_period:
                raise ParameterError(
                    f"balance.{name}.time_constant: {level.time_constant:g} is too short; allowed: from "
                    f"control_period, {self.control_period:g} s, on; raise it, or lower control_period"
                )

    @property
    def commanded_speed(self) -> float:
        return self.gait.ramp.speed

    @property
    def untested(self) -> tuple[str, ...]:
        """Nothing: the support keeps the body upright at every speed."""
        return ()

    def fields_for_speed(self, speed: float) -> dict[str, Any]:
        """The speed at the end of the ramp."""
        return {"gait.ramp.speed": speed}

    def steady_from(self, subject: Subject) -> float:
        """When the ramp is over and the first foot has landed [s]."""
        return float(max(self.gait.ramp.duration, self.walk(subject).start_time))

    def actuator_gains(self, subject: Subject) -> tuple[Array, Array]:
        return joint_gains(kinematics_plant(subject), self.gains, subject.scale)

    def start_posture(self, subject: Subject, terrain: Terrain) -> StartPosture:
        """Standing: legs straight, soles parallel to the ground along x, arms in the middle of their swing."""
        slope = start_slope(terrain)
        ankles = {LEGS[side].ankle: slope for side in SIDES}
        return StartPosture({name: joint.middle for name, joint in arm_joints(self.gait.arms).items()} | ankles)

    def add_to(self, world: World) -> JointCommand:
        """Add gait, arms, inverse_kinematics, support and, where enabled, the balance levels between them."""
        gait, arms, solver = self._add_source(world)
        targets, posture = gait.GetOutputPort("sole_targets"), arms.GetOutputPort("posture")
        balance = scaled(self.balance, world.subject.scale)
        if balance.foot_force.enabled:
            weight = world.subject.known_mass * GRAVITY
            level_1 = world.add(
                "foot_force_balance",
                FootForceBalance(weight, balance.foot_force, self.control_period),
                sole_targets=targets,
                contact_schedule=gait.GetOutputPort("contact_schedule"),
                foot_forces=world.port("foot_contact", "foot_forces"),
            )
            targets = level_1.GetOutputPort("shifted_targets")
        if balance.upper_body.enabled:
            level_2 = world.add(
                "upper_body_balance",
                UpperBodyBalance(world.joints.names, balance.upper_body, self.control_period),
                posture=posture,
                soles=world.port("body_observer", "soles"),
                com=world.port("body_observer", "com"),
            )
            posture = level_2.GetOutputPort("balanced_posture")
        world.builder.Connect(targets, solver.GetInputPort("sole_targets"))
        world.builder.Connect(posture, solver.GetInputPort("posture"))
        add_support(world, balance.support, gait.GetOutputPort("pelvis_reference"))
        samples = ("desired_state", "sample_time", "previous_state", "previous_time")
        return JointCommand(**{name: solver.GetOutputPort(name) for name in samples})

    def add_reference(self, world: World) -> tuple[OutputPort, OutputPort]:
        gait, arms, solver = self._add_source(world)
        world.builder.Connect(gait.GetOutputPort("sole_targets"), solver.GetInputPort("sole_targets"))
        world.builder.Connect(arms.GetOutputPort("posture"), solver.GetInputPort("posture"))
        between = world.add(
            "interpolator",
            PostureInterpolator(len(world.joints.names)),
            previous_state=solver.GetOutputPort("previous_state"),
            previous_time=solver.GetOutputPort("previous_time"),
            next_state=solver.GetOutputPort("desired_state"),
            next_time=solver.GetOutputPort("sample_time"),
        )
        return gait.GetOutputPort("pelvis_reference"), between.GetOutputPort("desired_state")

    def walk(self, subject: Subject) -> WalkingGait:
        """The walk on level ground as a function of time."""
        return WalkingGait(self.gait.path, subject.skeleton.hip_half_width, self.gait.ramp, self.gait.first_swing)

    def walk_on(self, terrain: Terrain, subject: Subject) -> GaitOnGround:
        """The walk on a terrain as a function of time."""
        gait = self.gait
        footholds, clearance = scaled(gait.footholds, subject.scale), scaled(gait.clearance, subject.scale)
        return GaitOnGround(gait.path, gait.ramp, gait.first_swing, terrain, subject.skeleton, footholds, clearance)

    def _add_source(self, world: World) -> tuple[GaitSplineSource, ArmSwingSource, InverseKinematicsSolver]:
        """Add gait, arms and inverse_kinematics, which run one control period ahead; the last is not connected.

        Raises:
            ParameterError: the legs cannot follow the foot path on the terrain.
        """
        require_reachable(world.subject, self.gait.path, self.inverse_kinematics)
        walk = self.walk_on(world.terrain, world.subject)
        require_reachable_on(world.terrain, world.subject, walk, self.inverse_kinematics)
        skeleton, period = world.subject.skeleton, self.control_period
        start = self.start_posture(world.subject, world.terrain).angles
        names = JointMap.of(world.model).names
        return (
            world.add("gait", GaitSplineSource(walk, skeleton, preview=period)),
            world.add("arms", ArmSwingSource(names, walk, self.gait.arms, preview=period)),
            world.add(
                "inverse_kinematics",
                InverseKinematicsSolver(world.model, self.inverse_kinematics, period, period, start_posture=start),
            ),
        )
