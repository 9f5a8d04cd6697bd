"""The controller that balances: step planner and whole-body program, no external force."""

from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, Self

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.framework import OutputPort

from humanwalk.body.contact import sole_extent
from humanwalk.body.hanging_arm import hanging_arms
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import ARMS, LEGS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.body.upright import knee_flexions
from humanwalk.body_units import scaled
from humanwalk.choices.controller import JointCommand
from humanwalk.choices.start import StartPosture, load_lean, start_slope
from humanwalk.choices.style import STYLES, NoStyle, Style
from humanwalk.choices.world import World
from humanwalk.control.felt_load import LoadFeeling
from humanwalk.control.gain_noise import noisy_tasks
from humanwalk.control.whole_body_parameters import WholeBodyParameters
from humanwalk.motion.walking_posture import height_ratio
from humanwalk.numerics import Array
from humanwalk.numerics.random_stream import RandomStream
from humanwalk.numerics.scalars import clip
from humanwalk.quantity import ParameterError, choice, quantity, tag_of
from humanwalk.systems.gait_planner import GaitPlanner
from humanwalk.systems.load_observer import LoadObserver
from humanwalk.systems.whole_body_controller import WholeBodyController
from humanwalk.terrain import Terrain
from humanwalk.walking.command import CommandParameters
from humanwalk.walking.knowledge import KNOWLEDGE, ExactKnowledge, TerrainKnowledge
from humanwalk.walking.parameters import StepPlannerParameters

START_FLEXION = 0.12
"""Flexion of hip and ankle at the start, half of the knee's [rad]: a straight leg cannot be shortened."""

SETTLING = 2.0
"""Time from the end of the first change of speed to the part of the walk that is measured, for the reference body [s]
(our choice): four steps. At 1.2 m/s the first stride of that part is 5 % faster than those three strides later."""


@dataclass(frozen=True)
class CompliantGains:
    """PD gains beside the feedforward torque: joints are damped, the small joints of the feet also held.

    Values are for the reference body and scale with the subject.
    """

    damping: float = quantity(1.0, "N m s/rad", 0.0, 100.0)
    """Damping of every joint towards the planned rate."""

    foot_stiffness: float = quantity(500.0, "N m/rad", 0.0, 1e5)
    """Stiffness with which the actuators hold ankle rotation, midfoot and toes at their desired angles."""

    foot_damping: float = quantity(10.0, "N m s/rad", 0.0, 1e3)
    """Damping of the same."""


@dataclass(frozen=True)
class BalancedController:
    """Command, step planner and whole-body program; the last two run every control period.

    Values of planner, program and gains are for the reference body and scale with the subject
    (docs/reference/gains.md).
    """

    command: CommandParameters = CommandParameters()
    """Speed and heading over time."""

    knowledge: TerrainKnowledge = choice(KNOWLEDGE, ExactKnowledge())
    """What planner and whole-body program know of the terrain."""

    planner: StepPlannerParameters = StepPlannerParameters()
    """Steps and balance; values are for the reference body and scale with the subject."""

    whole_body: WholeBodyParameters = WholeBodyParameters()
    """Joint torques; values are for the reference body and scale with the subject."""

    style: Style = choice(STYLES, NoStyle())
    """Joint angles that the legs follow softly, beside steps and balance."""

    load_feeling: LoadFeeling = LoadFeeling()
    """How the walker feels a load that its model of the body lacks."""

    gains: CompliantGains = CompliantGains()
    """PD gains of the joints; values are for the reference body and scale with the subject."""

    first_swing: Literal["Right", "Left"] = "Right"
    """Leg that swings first."""

    elbow_flexion: float = quantity(0.35, "rad", 0.0, 1.5)
    """Flexion of the elbows while the arms hang without a load."""

    wrist_flexion: float = quantity(0.0, "rad", -0.5, 1.0)
    """Palmar flexion of the wrists."""

    control_period: float = quantity(0.006, "s", 0.001, 0.01)
    """Time between two plans and solutions: three steps of the plant. The tables of docs/robustness.md hold for it."""

    physics = True

    @property
    def commanded_speed(self) -> float:
        return self.command.greatest_forward

    @property
    def untested(self) -> tuple[str, ...]:
        return self.command.untested

    @property
    def followed_style(self) -> str:
        return tag_of(STYLES, self.style)

    def fields_for_speed(self, speed: float) -> dict[str, Any]:
        """The points of the command."""
        return {"command.points": [asdict(point) for point in self.command.points_at_speed(speed)]}

    def steady_from(self, subject: Subject) -> float:
        """When the first speed that is commanded is reached and the walk has settled [s]."""
        first = next((point for point in self.command.points if point.forward or point.sideways), None)
        if first is None:
            return 0.0
        time = subject.scale.time
        ramp = max(abs(first.forward), abs(first.sideways)) / self.command.acceleration
        return first.time + time * self.planner.timing.weight_shift + ramp + time * SETTLING

    def fitted(self, subject: Subject) -> Self:
        """The controller in the units of a subject's body, with the walking height of its proportions."""
        scale = subject.scale
        planner = scaled(self.planner, scale)
        height = replace(planner.height, walking=height_ratio(subject) * planner.height.walking)
        return replace(
            self,
            planner=replace(planner, height=height),
            whole_body=scaled(self.whole_body, scale),
            gains=scaled(self.gains, scale),
            style=scaled(self.style, scale),
            load_feeling=scaled(self.load_feeling, scale),
        )

    def actuator_gains(self, subject: Subject) -> tuple[Array, Array]:
        gains = scaled(self.gains, subject.scale)
        foot = np.isin(
            JointMap.of(kinematics_plant(subject)).names, [joint for leg in LEGS.values() for joint in leg.foot_joints]
        )
        return np.where(foot, gains.foot_stiffness, 0.0), np.where(foot, gains.foot_damping, gains.damping)

    def start_posture(self, subject: Subject, terrain: Terrain) -> StartPosture:
        """Standing on bent legs, the soles parallel to the ground along x; it leans against known loads."""
        lean = load_lean(subject)
        slope = start_slope(terrain)
        angles = self._hanging_arms(subject)
        for side, flexion in knee_flexions(subject.skeleton, 2.0 * START_FLEXION).items():
            leg = LEGS[side]
            angles |= {leg.hip_flexion: 0.5 * flexion, leg.knee: flexion, leg.ankle: 0.5 * flexion + slope + lean}
        return StartPosture(angles, RigidTransform(RollPitchYaw(0.0, lean, 0.0), np.zeros(3)))

    def add_to(self, world: World) -> JointCommand:
        """Add command, load_observer, planner and controller.

        Raises:
            ParameterError: the plant is continuous.
        """
        if world.plant.time_step() == 0:
            raise ParameterError(
                "controller: balanced needs the discrete plant; allowed: simulation.integrator: discrete; set it"
            )
        fitted = self.fitted(world.subject)
        command = world.add("command", world.sources.command(self.command))
        load = world.add(
            "load_observer",
            LoadObserver(world.model, fitted.load_feeling, self.control_period),
            state=world.state,
            foot_forces=world.port("foot_contact", "foot_forces"),
        ).GetOutputPort("load")
        world.builder.Connect(load, world.builder.GetSubsystemByName("body_observer").GetInputPort("load"))
        errors = RandomStream.KNOWLEDGE_ERRORS.of(world.seed)
        planner = world.add(
            "planner",
            GaitPlanner(
                world.model,
                fitted.planner,
                self.first_swing,
                self.control_period,
                sole_extent(world.subject.skeleton),
                self.knowledge.ground(world.terrain, errors, fitted.planner.feeling),
                hanging_arms(world.subject),
            ),
            com=world.port("body_observer", "com"),
            ankles=world.port("body_observer", "ankles"),
            foot_forces=world.port("foot_contact", "foot_forces"),
            command=command.GetOutputPort("command"),
            load=load,
        )
        tasks = noisy_tasks(fitted.whole_body, world.start.gain_noise, RandomStream.TASK_GAINS.of(world.seed))
        posture = self._hanging_arms(world.subject)
        style = fitted.style.task(world.subject, JointMap.of(world.model))
        controller = world.add(
            "controller",
            WholeBodyController(world.model, world.subject.skeleton, tasks, posture, self.control_period, style),
            state=world.state,
            plan=planner.GetOutputPort("plan"),
            load=load,
        )
        if world.known_assistance is not None:
            world.builder.Connect(world.known_assistance, controller.GetInputPort("assistance"))
        state, time, torque = map(controller.GetOutputPort, ("desired_state", "sample_time", "torque"))
        return JointCommand(state, time, feedforward=torque)

    def _hanging_arms(self, subject: Subject) -> dict[str, float]:
        """Angles [rad] of hanging arms by joint, within its range; an arm that carries a load is straighter."""
        elbows = {ARMS[side].elbow: arm.freedom() * self.elbow_flexion for side, arm in hanging_arms(subject).items()}
        angles = elbows | {arm.wrist: self.wrist_flexion for arm in ARMS.values()}
        skeleton = subject.known_skeleton
        return {name: clip(angle, *skeleton.joint(name).range_rad) for name, angle in angles.items()}

    def add_reference(self, world: World) -> tuple[OutputPort, OutputPort]:
        """Raise ParameterError: a plan depends on the simulated state."""
        raise ParameterError(
            "make_playback: balanced has no motion to show without physics; allowed: thesis, recorded; build it with "
            "make_walker"
        )
