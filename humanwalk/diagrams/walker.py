"""The thesis' walker as a Diagram: gait, inverse kinematics, PD actuators, plant, assumed balance, observers."""

from dataclasses import dataclass

from pydrake.multibody.tree import UniformGravityFieldElement
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort

from humanwalk.body.joint_map import base_first_mass_matrix
from humanwalk.body.plant import Subject
from humanwalk.choices.contact import FootContact, add_foot_contact, connect_spatial_forces
from humanwalk.choices.reference import add_walking_reference, make_recorded_motion
from humanwalk.choices.start import require_reachable, start_positions
from humanwalk.choices.world import HumanPlant, add_human_plant
from humanwalk.control.balance_support import BalanceSupportParameters, largest_support_step
from humanwalk.control.pd_control import PdLaw
from humanwalk.numerics.stability import round_down
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario
from humanwalk.systems.balance_support import BalanceSupport
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.foot_force_balance import FootForceBalance
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.pd_actuator_bank import PdActuatorBank
from humanwalk.systems.recorded_posture_source import RecordedPostureSource
from humanwalk.systems.upper_body_balance import UpperBodyBalance


def make_walker(scenario: Scenario, visuals: bool = True) -> Diagram:
    """Wire the walker of a scenario; its default context stands at the scenario's start.

    Subsystems by name: plant, scene_graph, gait, arms, inverse_kinematics, actuators, body_observer,
    foot_force_observer and, where the scenario enables them, support, foot_force_balance, upper_body_balance. A
    scenario that follows a recording has recording instead of gait, arms and inverse_kinematics; one with
    `contact: asperity` has foot_contact instead of foot_force_observer.

    Exported outputs, joints in actuator order:
        state (97): plant state [q; v].
        query_object: SceneGraph's, for a visualiser.
        contact_results: the plant's.
        torque (42): what every joint feels of its actuator [N m].
        saturated (42): 1 where an actuator is at its limit.
        desired_state (84): desired joint angles [rad], rates [rad/s].
        ik_status (6): see InverseKinematicsSolver; not with a recording.
        pelvis_reference (13): where the pelvis should be in W: quaternion, position, angular velocity, velocity.
        phase (2), contact_schedule (2): see GaitSplineSource; not with a recording.
        soles (6), com (6): see BodyObserver.
        foot_forces (16), friction_use (2): see FootForceObserver.
        support_wrench (6): torque [N m], force [N] of the assumed balance on the pelvis; with the support.
        foot_shift (12): see FootForceBalance; with balance level 1.
        alpha (4): see UpperBodyBalance; with balance level 2.

    Exported input:
        feedforward (42): torque added to every actuator's law [N m]; optional.

    Args:
        scenario: what is simulated.
        visuals: whether there is anything to see; what nobody sees costs, too.

    Raises:
        ParameterError: the scenario's start, gait or recording cannot be followed, or its actuators would be unstable.
    """
    builder = DiagramBuilder()
    human = add_human_plant(builder, scenario, visuals)
    plant = human.plant
    bank = builder.AddNamedSystem(
        "actuators", PdActuatorBank(plant, human.kp, human.kd, scenario.actuators.law, human.effort_limits)
    )
    body = builder.AddNamedSystem("body_observer", BodyObserver(plant))
    feet = add_foot_contact(builder, scenario, human)
    connect_spatial_forces(builder, human, feet.spatial_forces)
    builder.Connect(plant.get_state_output_port(), body.GetInputPort("state"))

    if scenario.follow.file:
        reference = _add_recording(builder, scenario, human, bank)
    else:
        reference = _add_gait(builder, scenario, human, bank, body, feet)
    builder.Connect(plant.get_state_output_port(), bank.GetInputPort("state"))
    builder.Connect(plant.get_net_actuation_output_port(), bank.GetInputPort("net_actuation"))
    builder.ExportInput(bank.GetInputPort("feedforward"), "feedforward")
    builder.Connect(bank.GetOutputPort("actuation"), plant.get_actuation_input_port())
    if scenario.actuators.law == "implicit":
        builder.Connect(
            bank.GetOutputPort("plant_desired_state"),
            plant.get_desired_state_input_port(human.instance),
        )

    if scenario.balance.support.enabled:
        subject, reference_body = scenario.subject, Subject()
        parameters = scenario.balance.support.scaled(
            subject.mass / reference_body.mass, subject.stature / reference_body.stature
        )
        _require_stable_support(human, parameters, scenario.actuators.law)
        support = builder.AddNamedSystem("support", BalanceSupport(plant, parameters))
        builder.Connect(reference.pelvis, support.GetInputPort("pelvis_reference"))
        builder.Connect(plant.get_state_output_port(), support.GetInputPort("state"))
        builder.Connect(support.GetOutputPort("generalized_force"), plant.get_applied_generalized_force_input_port())
        builder.ExportOutput(support.GetOutputPort("wrench"), "support_wrench")

    for port, name in (
        (plant.get_state_output_port(), "state"),
        (human.scene_graph.get_query_output_port(), "query_object"),
        (plant.get_contact_results_output_port(), "contact_results"),
        (bank.GetOutputPort("torque"), "torque"),
        (bank.GetOutputPort("saturated"), "saturated"),
        (bank.GetOutputPort("held_desired_state"), "desired_state"),
        (reference.pelvis, "pelvis_reference"),
        *((port, name) for name, port in reference.exports.items()),
        (body.GetOutputPort("soles"), "soles"),
        (body.GetOutputPort("com"), "com"),
        (feet.foot_forces, "foot_forces"),
        (feet.friction_use, "friction_use"),
    ):
        builder.ExportOutput(port, name)
    diagram = builder.Build()
    diagram.set_name("walker")
    return diagram


@dataclass(frozen=True)
class _Reference:
    """Ports of the walking reference besides the joints' desired state."""

    pelvis: OutputPort
    exports: dict[str, OutputPort]


def _add_recording(builder: DiagramBuilder, scenario: Scenario, human: HumanPlant, bank: PdActuatorBank) -> _Reference:
    """Add the recording that the scenario follows; the plant starts where it does."""
    motion = make_recorded_motion(scenario)
    human.plant.SetDefaultPositions(start_positions(scenario, motion))
    source = builder.AddNamedSystem("recording", RecordedPostureSource(motion))
    builder.Connect(source.GetOutputPort("desired_state"), bank.GetInputPort("desired_state"))
    return _Reference(source.GetOutputPort("pelvis_reference"), {})


def _add_gait(
    builder: DiagramBuilder,
    scenario: Scenario,
    human: HumanPlant,
    bank: PdActuatorBank,
    body: BodyObserver,
    feet: FootContact,
) -> _Reference:
    """Add gait, arms, inverse kinematics and the balance levels between them; the plant starts standing."""
    require_reachable(scenario)
    human.plant.SetDefaultPositions(start_positions(scenario))
    walking = add_walking_reference(builder, scenario)
    gait, solver = walking.gait, walking.inverse_kinematics
    exports = {
        "ik_status": solver.GetOutputPort("status"),
        "phase": gait.GetOutputPort("phase"),
        "contact_schedule": gait.GetOutputPort("contact_schedule"),
    }
    sole_targets = gait.GetOutputPort("sole_targets")
    if scenario.balance.foot_force.enabled:
        level_1 = _add_foot_force_balance(builder, scenario, gait, feet)
        sole_targets = level_1.GetOutputPort("shifted_targets")
        exports["foot_shift"] = level_1.GetOutputPort("shift")
    builder.Connect(sole_targets, solver.GetInputPort("sole_targets"))

    posture = walking.arms.GetOutputPort("posture")
    if scenario.balance.upper_body.enabled:
        level_2 = builder.AddNamedSystem(
            "upper_body_balance",
            UpperBodyBalance(
                human.joints.names,
                scenario.balance.upper_body,
                scenario.simulation.control_period,
            ),
        )
        builder.Connect(posture, level_2.GetInputPort("posture"))
        builder.Connect(body.GetOutputPort("soles"), level_2.GetInputPort("soles"))
        builder.Connect(body.GetOutputPort("com"), level_2.GetInputPort("com"))
        exports["alpha"] = level_2.GetOutputPort("alpha")
        posture = level_2.GetOutputPort("balanced_posture")
    builder.Connect(posture, solver.GetInputPort("posture"))
    for port in ("desired_state", "sample_time", "previous_state", "previous_time"):
        builder.Connect(solver.GetOutputPort(port), bank.GetInputPort(port))
    return _Reference(gait.GetOutputPort("pelvis_reference"), exports)


def _require_stable_support(human: HumanPlant, parameters: BalanceSupportParameters, law: PdLaw) -> None:
    """Raise ParameterError if the support, an explicit force, would diverge at the plant's step."""
    plant = human.plant
    M = base_first_mass_matrix(plant, plant.CreateDefaultContext())
    stable = largest_support_step(M, human.kp, human.kd, law, parameters)
    if plant.time_step() > stable:
        raise ParameterError(
            f"balance.support: unstable at time_step {plant.time_step():g} s; allowed: steps up to "
            f"{round_down(stable):g} s with this stiffness and damping; lower simulation.time_step, or "
            "rotational_damping and damping"
        )


def _add_foot_force_balance(
    builder: DiagramBuilder,
    scenario: Scenario,
    gait: GaitSplineSource,
    feet: FootContact,
) -> FootForceBalance:
    """Add balance level 1 between the gait and the inverse kinematics."""
    level_1: FootForceBalance = builder.AddNamedSystem(
        "foot_force_balance",
        FootForceBalance(
            scenario.subject.mass * UniformGravityFieldElement.kDefaultStrength,
            scenario.balance.foot_force,
            scenario.simulation.control_period,
        ),
    )
    builder.Connect(gait.GetOutputPort("sole_targets"), level_1.GetInputPort("sole_targets"))
    builder.Connect(gait.GetOutputPort("contact_schedule"), level_1.GetInputPort("contact_schedule"))
    builder.Connect(feet.foot_forces, level_1.GetInputPort("foot_forces"))
    return level_1
