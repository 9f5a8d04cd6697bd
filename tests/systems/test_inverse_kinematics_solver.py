"""Inverse kinematics system: solved once a period, outputs are state, the status tells what was reached."""

from typing import Any

import numpy as np
import pytest
from pydrake.math import RigidTransform
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder
from pydrake.systems.primitives import LogVectorOutput

from humanwalk.body import SIDES
from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.skeleton import Skeleton
from humanwalk.control.inverse_kinematics import (
    ROW_WEIGHTS,
    SINGULAR_VALUE_FLOOR,
    InverseKinematicsParameters,
    InverseKinematicsSolution,
    LegKinematics,
    pose_error,
)
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.numerics import Array
from humanwalk.sides import Side
from humanwalk.systems import inverse_kinematics_solver as module
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver

N = 42
PERIOD = 0.005
THETA = np.array([0.4, 0.0, 0.0, 0.8, 0.1, 0.0, 0.0])
V = np.array([0.0, 0.2, 0.0, 0.3, 0.0, 0.5])


@pytest.fixture
def solver(plant: MultibodyPlant) -> InverseKinematicsSolver:
    return InverseKinematicsSolver(plant, InverseKinematicsParameters(), PERIOD)


@pytest.fixture
def places(joints: JointMap) -> dict[Side, list[int]]:
    return {side: [joints.names.index(name) for name in LEGS[side].chain] for side in SIDES}


def sole_target(X_PS: RigidTransform, V_PS: Array = V) -> Array:
    return np.concatenate((X_PS.rotation().ToQuaternion().wxyz(), X_PS.translation(), V_PS))


def fixed_context(solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics]) -> Context:
    context = solver.CreateDefaultContext()
    targets = [sole_target(legs[side].X_PS(THETA)) for side in SIDES]
    solver.GetInputPort("sole_targets").FixValue(context, np.concatenate(targets))
    return context


def initialized(solver: InverseKinematicsSolver, context: Context) -> Simulator:
    simulator = Simulator(solver, context)
    simulator.Initialize()
    return simulator


@pytest.fixture
def count_solutions(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    times = []
    solve = module.solve_inverse_kinematics  # type: ignore[attr-defined]

    def counted(*arguments: Any) -> InverseKinematicsSolution:
        times.append(len(times))
        return solve(*arguments)

    monkeypatch.setattr(module, "solve_inverse_kinematics", counted)
    return times


def test_ports(solver: InverseKinematicsSolver) -> None:
    inputs = [solver.get_input_port(i).get_name() for i in range(solver.num_input_ports())]
    assert sorted(inputs) == ["posture", "sole_targets"]
    assert solver.GetInputPort("sole_targets").size() == 26
    assert solver.GetInputPort("posture").size() == 2 * N
    for port, name, size in (
        (solver.GetOutputPort("desired_state"), "desired_state", 2 * N),
        (solver.GetOutputPort("sample_time"), "sample_time", 1),
        (solver.GetOutputPort("status"), "status", 6),
    ):
        assert (port.get_name(), port.size()) == (name, size)


def test_initialization_solves_for_time_zero(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics], places: dict[Side, list[int]]
) -> None:
    context = fixed_context(solver, legs)
    initialized(solver, context)
    q, _ = np.split(solver.GetOutputPort("desired_state").Eval(context), 2)
    for side in SIDES:
        error = pose_error(legs[side].X_PS(q[places[side]]), legs[side].X_PS(THETA))
        np.testing.assert_allclose(error, 0.0, atol=1e-6)
    assert solver.GetOutputPort("sample_time").Eval(context)[0] == 0.0


def test_a_second_initialization_gives_the_same_bits(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics]
) -> None:
    context = fixed_context(solver, legs)
    initialized(solver, context)
    once = [solver.GetOutputPort(name).Eval(context).copy() for name in ("desired_state", "previous_state")]
    initialized(solver, context)
    for name, before in zip(("desired_state", "previous_state"), once, strict=True):
        np.testing.assert_array_equal(solver.GetOutputPort(name).Eval(context), before)


def test_rates_give_the_desired_velocity_of_the_soles(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics], places: dict[Side, list[int]]
) -> None:
    context = fixed_context(solver, legs)
    initialized(solver, context)
    q, v = np.split(solver.GetOutputPort("desired_state").Eval(context), 2)
    for side in SIDES:
        J = legs[side].jacobian(q[places[side]])
        np.testing.assert_allclose(J @ v[places[side]], V, atol=1e-9)


def test_reading_outputs_solves_nothing(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics], count_solutions: list[Any]
) -> None:
    context = fixed_context(solver, legs)
    for port in range(solver.num_output_ports()):
        solver.get_output_port(port).Eval(context)
    assert count_solutions == []
    assert not solver.HasAnyDirectFeedthrough()


def test_it_solves_both_legs_once_a_period(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics], count_solutions: list[Any]
) -> None:
    simulator = initialized(solver, fixed_context(solver, legs))
    at_start = len(count_solutions)
    sample_time = solver.GetOutputPort("sample_time")
    for k in range(1, 5):
        simulator.AdvanceTo((k + 0.5) * PERIOD)
        assert sample_time.Eval(simulator.get_context())[0] == pytest.approx(k * PERIOD)
    assert len(count_solutions) - at_start == 2 * 4


def test_between_updates_nothing_changes(solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics]) -> None:
    simulator = initialized(solver, fixed_context(solver, legs))
    simulator.AdvanceTo(1.2 * PERIOD)
    before = solver.GetOutputPort("desired_state").Eval(simulator.get_context())
    simulator.AdvanceTo(1.8 * PERIOD)
    np.testing.assert_array_equal(solver.GetOutputPort("desired_state").Eval(simulator.get_context()), before)


def test_status_of_a_reached_pose(solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics]) -> None:
    context = fixed_context(solver, legs)
    initialized(solver, context)
    status = solver.GetOutputPort("status").Eval(context)
    assert np.all(status[:2] <= 1e-6)
    assert np.all((status[2:4] >= 1) & (status[2:4] <= 50))
    np.testing.assert_array_equal(status[4:], [1, 1])


def test_a_pose_out_of_reach_is_reported_for_its_leg_only(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics], places: dict[Side, list[int]]
) -> None:
    context = fixed_context(solver, legs)
    far = RigidTransform(legs["Left"].X_PS(np.zeros(7)).translation() - [0.0, 0.0, 0.1])
    targets = np.concatenate((sole_target(legs["Right"].X_PS(THETA)), sole_target(far)))
    solver.GetInputPort("sole_targets").FixValue(context, targets)
    simulator = initialized(solver, context)
    simulator.AdvanceTo(2.5 * PERIOD)
    status = solver.GetOutputPort("status").Eval(context)
    np.testing.assert_array_equal(status[4:], [1, 0])
    assert status[1] == pytest.approx(0.1, abs=1e-3)
    desired = solver.GetOutputPort("desired_state").Eval(context)
    assert np.all(np.isfinite(desired))
    error = pose_error(legs["Left"].X_PS(desired[places["Left"]]), far)
    assert np.linalg.norm(error) == pytest.approx(status[1], abs=1e-9)


def test_posture_passes_except_for_the_legs(
    solver: InverseKinematicsSolver, legs: dict[Side, LegKinematics], places: dict[Side, list[int]]
) -> None:
    posture = np.arange(2.0 * N) / 100
    context = fixed_context(solver, legs)
    initialized(solver, context)
    alone = solver.GetOutputPort("desired_state").Eval(context).copy()
    context = fixed_context(solver, legs)
    solver.GetInputPort("posture").FixValue(context, posture)
    initialized(solver, context)
    together = solver.GetOutputPort("desired_state").Eval(context)
    in_legs = np.isin(np.arange(N), places["Right"] + places["Left"])
    for half, start in ((slice(0, N), 0), (slice(N, 2 * N), N)):
        np.testing.assert_array_equal(together[half][~in_legs], posture[start : start + N][~in_legs])
        np.testing.assert_allclose(together[half][in_legs], alone[half][in_legs], atol=1e-12)
        np.testing.assert_array_equal(alone[half][~in_legs], 0.0)


def test_before_the_first_solution_is_the_start_posture(plant: MultibodyPlant, joints: JointMap) -> None:
    solver = InverseKinematicsSolver(
        plant, InverseKinematicsParameters(), PERIOD, start_posture={LEGS["Right"].knee: 0.7}
    )
    context = solver.CreateDefaultContext()
    for port in (solver.GetOutputPort("desired_state"), solver.GetOutputPort("previous_state")):
        q, v = np.split(port.Eval(context), 2)
        assert q[joints.names.index(LEGS["Right"].knee)] == 0.7
        assert np.count_nonzero(q) == 1
        assert not v.any()


def test_it_keeps_the_previous_sample(plant: MultibodyPlant, legs: dict[Side, LegKinematics]) -> None:
    """With a preview of one period the present lies between the previous sample and the next."""
    solver = InverseKinematicsSolver(plant, InverseKinematicsParameters(), PERIOD, preview=PERIOD)
    simulator = initialized(solver, fixed_context(solver, legs))
    context = simulator.get_context()
    times = (solver.GetOutputPort("previous_time"), solver.GetOutputPort("sample_time"))
    assert [port.Eval(context)[0] for port in times] == pytest.approx([0.0, PERIOD])
    last = solver.GetOutputPort("desired_state").Eval(context).copy()
    for k in range(1, 4):
        simulator.AdvanceTo((k + 0.5) * PERIOD)
        assert [port.Eval(context)[0] for port in times] == pytest.approx([k * PERIOD, (k + 1) * PERIOD])
        np.testing.assert_array_equal(solver.GetOutputPort("previous_state").Eval(context), last)
        last = solver.GetOutputPort("desired_state").Eval(context).copy()


def walk(plant: MultibodyPlant, gait: WalkingGait, skeleton: Skeleton, period: float, until: float) -> Any:
    """Times, desired angles, desired rates and status of every solution on the thesis' walk."""
    builder = DiagramBuilder()
    source = builder.AddSystem(GaitSplineSource(gait, skeleton))
    solver = builder.AddSystem(InverseKinematicsSolver(plant, InverseKinematicsParameters(tolerance=1e-9), period))
    builder.Connect(source.GetOutputPort("sole_targets"), solver.GetInputPort("sole_targets"))
    ports = (
        solver.GetOutputPort("sample_time"),
        solver.GetOutputPort("desired_state"),
        solver.GetOutputPort("status"),
    )
    logs = [LogVectorOutput(port, builder, publish_period=period) for port in ports]
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(until)
    # A row published at an update's time shows the solution before it: the sample time tells which.
    sample_time, state, status = (log.FindLog(simulator.get_context()).data().T[1:] for log in logs)
    return sample_time[:, 0], *np.split(state, 2, axis=1), status


@pytest.fixture(scope="module")
def walked(plant: MultibodyPlant, gait: WalkingGait, skeleton: Skeleton) -> tuple[Array, Array, Array, Array]:
    return walk(plant, gait, skeleton, 0.002, 1.6)


def test_the_thesis_walk_is_within_reach(walked: tuple[Array, Array, Array, Array]) -> None:
    times, _, _, status = walked
    # The straight leg of the first 0.1 s falls short by hundredths of a millimeter: the pelvis has hardly dropped yet.
    assert status[:, :2].max() < 5e-5
    np.testing.assert_array_equal(status[times > 0.1, 4:], 1.0)


def test_angles_of_the_walk_stay_in_their_ranges(walked: tuple[Array, Array, Array, Array], joints: JointMap) -> None:
    _, q, _, _ = walked
    assert np.all((joints.lower <= q) & (q <= joints.upper))


def smallest_singular_value(leg: LegKinematics, theta: Array) -> float:
    return np.linalg.svd(ROW_WEIGHTS[:, None] * leg.jacobian(theta))[1][-1]


@pytest.mark.parametrize("side", SIDES)
def test_rates_of_the_walk_are_the_differences_of_its_angles(
    walked: tuple[Array, Array, Array, Array],
    legs: dict[Side, LegKinematics],
    places: dict[Side, list[int]],
    side: Side,
) -> None:
    """Wherever the leg is not so straight that the floor of the singular values slows the rates."""
    times, q, v = walked[0], walked[1][:, places[side]], walked[2][:, places[side]]
    h = times[1] - times[0]
    quotient = (q[2:] - q[:-2]) / (2 * h)
    error = np.abs(quotient - v[1:-1]).max(axis=1)
    # A central difference errs by h^2/6 of the third derivative, which third differences estimate; three times that
    # where an acceleration jumps, at lift-off and touchdown.
    third = np.abs(np.diff(q, n=3, axis=0)).max(axis=1) / h**3
    bound = np.array([h**2 / 2 * third[max(k - 3, 0) : k + 3].max() + 1e-3 for k in range(len(quotient))])
    regular = np.array([smallest_singular_value(legs[side], theta) > SINGULAR_VALUE_FLOOR for theta in q])
    regular = regular[:-2] & regular[1:-1] & regular[2:]
    assert np.all(error[regular] <= bound[regular])
    # Neither condition lets much pass: nearly the whole walk is looked at, within a hundredth of the fastest rate.
    assert regular.mean() > 0.9
    assert np.median(bound[regular]) < 0.01 * np.abs(v).max()


def test_a_straight_walk_never_turns_the_legs_sideways(
    walked: tuple[Array, Array, Array, Array], joints: JointMap
) -> None:
    _, q, _, _ = walked
    sideways = [
        joints.names.index(name)
        for leg in LEGS.values()
        for name in (leg.hip_abduction, leg.hip_rotation, leg.ankle_inversion, leg.ankle_rotation)
    ]
    assert np.abs(q[:, sideways]).max() < 1e-3
