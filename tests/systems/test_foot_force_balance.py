"""Balance level 1: sole targets that give way until the ground forces are the desired ones."""

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.analysis import Simulator

from humanwalk.body import SIDES
from humanwalk.control.balance_levels import FootForceBalanceParameters
from humanwalk.systems.foot_force_balance import FootForceBalance

WEIGHT = 686.0
PERIOD = 0.005
PARAMETERS = FootForceBalanceParameters(enabled=True)
X = {side: RigidTransform(RotationMatrix.MakeYRotation(0.2), [0.1 * i, 0.2, -0.9]) for i, side in enumerate(SIDES)}
V = {side: np.arange(6.0) + i for i, side in enumerate(SIDES)}


@pytest.fixture
def level():
    return FootForceBalance(WEIGHT, PARAMETERS, PERIOD)


def simulator_of(level, schedule=(1, 1), vertical=(WEIGHT / 2, WEIGHT / 2)):
    context = level.CreateDefaultContext()
    for side in SIDES:
        level.get_sole_pose_input_port(side).FixValue(context, Value(X[side]))
        level.get_sole_velocity_input_port(side).FixValue(context, Value(SpatialVelocity(V[side])))
    level.get_contact_schedule_input_port().FixValue(context, np.array(schedule, dtype=float))
    forces = np.zeros((2, 8))
    forces[:, 2] = vertical
    # Centres of pressure and moments are not looked at.
    forces[:, 3:] = 7.0
    level.get_foot_forces_input_port().FixValue(context, forces.ravel())
    return Simulator(level, context)


def shift_and_rate(level, simulator):
    return np.split(level.get_shift_output_port().Eval(simulator.get_context()), 2)


def test_ports(level):
    names = {level.get_input_port(i).get_name() for i in range(level.num_input_ports())}
    assert names == {"X_PRs", "X_PLs", "V_PRs", "V_PLs", "contact_schedule", "foot_forces"}
    assert level.get_contact_schedule_input_port().size() == 2
    assert level.get_foot_forces_input_port().size() == 16
    port = level.get_shift_output_port()
    assert (port.get_name(), port.size()) == ("shift", 12)
    for side in SIDES:
        assert level.get_sole_pose_input_port(side).get_name() == f"X_P{side[0]}s"
        assert level.get_sole_velocity_input_port(side).get_name() == f"V_P{side[0]}s"
        assert level.get_sole_pose_output_port(side).get_name() == f"X_P{side[0]}s_shifted"
        assert level.get_sole_velocity_output_port(side).get_name() == f"V_P{side[0]}s_shifted"


@pytest.mark.parametrize(
    ("schedule", "vertical"), [((1, 1), (WEIGHT / 2, WEIGHT / 2)), ((1, 0), (WEIGHT, 0)), ((0, 0), (0, 0))]
)
def test_with_the_desired_forces_the_plan_passes_unchanged(level, schedule, vertical):
    simulator = simulator_of(level, schedule, vertical)
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    np.testing.assert_array_equal(level.get_shift_output_port().Eval(context), 0.0)
    for side in SIDES:
        assert level.get_sole_pose_output_port(side).Eval(context).IsExactlyEqualTo(X[side])
        V_shifted = level.get_sole_velocity_output_port(side).Eval(context)
        np.testing.assert_array_equal(V_shifted.get_coeffs(), V[side])


def test_a_foot_without_its_share_is_pressed_down_and_the_other_drawn_up(level):
    simulator = simulator_of(level, vertical=(0.0, WEIGHT))
    simulator.AdvanceTo(0.1)
    shift, _ = shift_and_rate(level, simulator)
    right, left = shift.reshape(2, 3)
    assert right[2] < 0 < left[2]
    np.testing.assert_array_equal(shift.reshape(2, 3)[:, :2], 0.0)


def test_shift_and_its_rate_are_added_to_the_plan(level):
    simulator = simulator_of(level, vertical=(0.0, WEIGHT))
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    shift, rate = (part.reshape(2, 3) for part in shift_and_rate(level, simulator))
    for i, side in enumerate(SIDES):
        X_shifted = level.get_sole_pose_output_port(side).Eval(context)
        np.testing.assert_allclose(X_shifted.translation(), X[side].translation() + shift[i])
        np.testing.assert_array_equal(X_shifted.rotation().matrix(), X[side].rotation().matrix())
        V_shifted = level.get_sole_velocity_output_port(side).Eval(context).get_coeffs()
        np.testing.assert_allclose(V_shifted, V[side] + np.concatenate((np.zeros(3), rate[i])))


def test_the_rate_is_what_the_shift_does_until_the_next_update(level):
    simulator = simulator_of(level, vertical=(0.0, WEIGHT))
    for k in range(5):
        simulator.AdvanceTo((k + 0.5) * PERIOD)
        shift, rate = shift_and_rate(level, simulator)
        assert np.abs(rate).max() > 0
        simulator.AdvanceTo((k + 1.5) * PERIOD)
        np.testing.assert_allclose(shift_and_rate(level, simulator)[0], shift + PERIOD * rate, atol=1e-15)


def test_the_shift_stays_within_its_bound(level):
    simulator = simulator_of(level, vertical=(0.0, 100 * WEIGHT))
    simulator.AdvanceTo(2.0)
    shift, rate = shift_and_rate(level, simulator)
    assert np.abs(shift).max() == pytest.approx(PARAMETERS.max_shift)
    assert np.abs(shift).max() <= PARAMETERS.max_shift * (1 + 1e-12)
    np.testing.assert_allclose(rate, 0.0, atol=1e-6)


def test_the_period_does_not_change_where_it_goes():
    shifts = []
    for period in (PERIOD, PERIOD / 8):
        level = FootForceBalance(WEIGHT, PARAMETERS, period)
        simulator = simulator_of(level, vertical=(0.0, WEIGHT))
        simulator.AdvanceTo(0.1 + 0.5 * period)
        shifts.append(shift_and_rate(level, simulator)[0])
    np.testing.assert_allclose(shifts[0], shifts[1], atol=0.05 * np.abs(shifts[1]).max())
