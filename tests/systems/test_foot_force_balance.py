"""Balance level 1: sole targets that move until the ground reaction forces are the desired ones."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.control.balance_levels import FootForceBalanceParameters
from humanwalk.numerics import Array
from humanwalk.systems.foot_force_balance import FootForceBalance

WEIGHT = 686.0
PERIOD = 0.005
PARAMETERS = FootForceBalanceParameters(enabled=True)
TARGETS = np.arange(26.0)


@pytest.fixture
def level() -> FootForceBalance:
    return FootForceBalance(WEIGHT, PARAMETERS, PERIOD)


def simulator_of(
    level: FootForceBalance, schedule: tuple[int, int] = (1, 1), vertical: tuple[float, ...] = (WEIGHT / 2, WEIGHT / 2)
) -> Simulator:
    context = level.CreateDefaultContext()
    level.GetInputPort("sole_targets").FixValue(context, TARGETS)
    level.GetInputPort("contact_schedule").FixValue(context, np.array(schedule, dtype=float))
    forces = np.zeros((2, 8))
    forces[:, 2] = vertical
    # Centers of pressure and moments are not used.
    forces[:, 3:] = 7.0
    level.GetInputPort("foot_forces").FixValue(context, forces.ravel())
    return Simulator(level, context)


def shift_and_rate(level: FootForceBalance, simulator: Simulator) -> list[Array]:
    return np.split(level.GetOutputPort("shift").Eval(simulator.get_context()), 2)


def test_ports(level: FootForceBalance) -> None:
    names = {level.get_input_port(i).get_name() for i in range(level.num_input_ports())}
    assert names == {"sole_targets", "contact_schedule", "foot_forces"}
    assert level.GetInputPort("sole_targets").size() == 26
    assert level.GetInputPort("contact_schedule").size() == 2
    assert level.GetInputPort("foot_forces").size() == 16
    port = level.GetOutputPort("shift")
    assert (port.get_name(), port.size()) == ("shift", 12)
    port = level.GetOutputPort("shifted_targets")
    assert (port.get_name(), port.size()) == ("shifted_targets", 26)


@pytest.mark.parametrize(
    ("schedule", "vertical"), [((1, 1), (WEIGHT / 2, WEIGHT / 2)), ((1, 0), (WEIGHT, 0)), ((0, 0), (0, 0))]
)
def test_with_the_desired_forces_the_targets_do_not_change(
    level: FootForceBalance, schedule: tuple[int, int], vertical: tuple[float, ...]
) -> None:
    simulator = simulator_of(level, schedule, vertical)
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    np.testing.assert_allclose(level.GetOutputPort("shift").Eval(context), 0.0, atol=1e-12)
    np.testing.assert_allclose(level.GetOutputPort("shifted_targets").Eval(context), TARGETS, atol=1e-12)


def test_the_target_of_an_unloaded_foot_moves_down_and_the_other_up(level: FootForceBalance) -> None:
    simulator = simulator_of(level, vertical=(0.0, WEIGHT))
    simulator.AdvanceTo(0.1)
    shift, _ = shift_and_rate(level, simulator)
    right, left = shift.reshape(2, 3)
    assert right[2] < 0 < left[2]
    np.testing.assert_allclose(shift.reshape(2, 3)[:, :2], 0.0, atol=1e-12)


def test_shift_and_rate_are_added_to_the_targets(level: FootForceBalance) -> None:
    simulator = simulator_of(level, vertical=(0.0, WEIGHT))
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    shift, rate = (part.reshape(2, 3) for part in shift_and_rate(level, simulator))
    added = np.zeros((2, 13))
    added[:, 4:7], added[:, 10:] = shift, rate
    np.testing.assert_allclose(
        level.GetOutputPort("shifted_targets").Eval(context), TARGETS + added.ravel(), atol=1e-12
    )


def test_the_shift_changes_at_its_rate_until_the_next_update(level: FootForceBalance) -> None:
    simulator = simulator_of(level, vertical=(0.0, WEIGHT))
    for k in range(5):
        simulator.AdvanceTo((k + 0.5) * PERIOD)
        shift, rate = shift_and_rate(level, simulator)
        assert np.abs(rate).max() > 0
        simulator.AdvanceTo((k + 1.5) * PERIOD)
        np.testing.assert_allclose(shift_and_rate(level, simulator)[0], shift + PERIOD * rate, atol=1e-15)


def test_the_shift_stays_within_its_bound(level: FootForceBalance) -> None:
    simulator = simulator_of(level, vertical=(0.0, 100 * WEIGHT))
    simulator.AdvanceTo(2.0)
    shift, rate = shift_and_rate(level, simulator)
    assert np.abs(shift).max() == pytest.approx(PARAMETERS.max_shift)
    assert np.abs(shift).max() <= PARAMETERS.max_shift * (1 + 1e-12)
    np.testing.assert_allclose(rate, 0.0, atol=1e-6)


def test_the_shift_does_not_depend_on_the_period() -> None:
    shifts = []
    for period in (PERIOD, PERIOD / 8):
        level = FootForceBalance(WEIGHT, PARAMETERS, period)
        simulator = simulator_of(level, vertical=(0.0, WEIGHT))
        simulator.AdvanceTo(0.1 + 0.5 * period)
        shifts.append(shift_and_rate(level, simulator)[0])
    np.testing.assert_allclose(shifts[0], shifts[1], atol=0.05 * np.abs(shifts[1]).max())
