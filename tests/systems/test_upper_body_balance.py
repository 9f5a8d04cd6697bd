"""Balance level 2: the spine bends against the lean of the body; other joints do not change."""

from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import SPINE_PITCH_JOINTS, SPINE_ROLL_JOINTS
from humanwalk.control.balance_levels import UpperBodyBalanceParameters
from humanwalk.numerics import Array
from humanwalk.systems.upper_body_balance import UpperBodyBalance

N = 42
PERIOD = 0.005
PARAMETERS = UpperBodyBalanceParameters(enabled=True, pitch_gain=0.5, roll_gain=0.4, time_constant=0.1)
POSTURE = np.arange(2.0 * N) / 100
SOLES = np.array([1.0, -0.1, 0.0, 1.2, 0.1, 0.02])


@pytest.fixture
def level(joints: JointMap) -> UpperBodyBalance:
    return UpperBodyBalance(joints.names, PARAMETERS, PERIOD)


def simulator_of(
    level: UpperBodyBalance, forward: Any = 0.0, leftward: float = 0.0, posture: Array = POSTURE
) -> Simulator:
    """A body that leans by these angles [rad] above the middle of its feet."""
    com = np.zeros(6)
    com[:3] = [1.1, 0.0, 0.01] + 0.9 * np.array([np.tan(forward), np.tan(leftward), 1.0])
    context = level.CreateDefaultContext()
    level.GetInputPort("posture").FixValue(context, posture)
    level.GetInputPort("soles").FixValue(context, SOLES)
    level.GetInputPort("com").FixValue(context, com)
    return Simulator(level, context)


def bend(level: UpperBodyBalance, simulator: Simulator) -> list[Array]:
    """Bend of angles and rates, by joint."""
    return np.split(level.GetOutputPort("balanced_posture").Eval(simulator.get_context()) - POSTURE, 2)


def test_ports(level: UpperBodyBalance) -> None:
    sizes = {level.get_input_port(i).get_name(): level.get_input_port(i).size() for i in range(level.num_input_ports())}
    assert sizes == {"posture": 2 * N, "soles": 6, "com": 6}
    for port, name, size in (
        (level.GetOutputPort("balanced_posture"), "balanced_posture", 2 * N),
        (level.GetOutputPort("alpha"), "alpha", 4),
    ):
        assert (port.get_name(), port.size()) == (name, size)
    assert level.GetInputPort("posture").get_name() == "posture"
    assert level.GetInputPort("soles").get_name() == "soles"
    assert level.GetInputPort("com").get_name() == "com"


def test_an_upright_body_keeps_its_posture(level: UpperBodyBalance) -> None:
    simulator = simulator_of(level)
    simulator.AdvanceTo(0.2)
    np.testing.assert_allclose(level.GetOutputPort("alpha").Eval(simulator.get_context()), 0.0, atol=1e-15)
    np.testing.assert_allclose(np.concatenate(bend(level, simulator)), 0.0, atol=1e-15)


def test_before_the_first_update_nothing_is_added(level: UpperBodyBalance) -> None:
    simulator = simulator_of(level, forward=0.2)
    np.testing.assert_allclose(np.concatenate(bend(level, simulator)), 0.0, atol=1e-15)


def test_leaning_forward_extends_the_spine_by_the_gain(level: UpperBodyBalance, joints: JointMap) -> None:
    simulator = simulator_of(level, forward=0.1)
    simulator.AdvanceTo(2.0)
    angles, _ = bend(level, simulator)
    pitch = [joints.names.index(name) for name in SPINE_PITCH_JOINTS]
    # Extension is negative: these joints flex about +y.
    assert np.all(angles[pitch] < 0)
    assert angles.sum() == pytest.approx(-0.5 * 0.1, rel=1e-6)
    np.testing.assert_allclose(np.delete(angles, pitch), 0.0, atol=1e-12)


def test_leaning_to_the_left_bends_the_spine_to_the_right(level: UpperBodyBalance, joints: JointMap) -> None:
    simulator = simulator_of(level, leftward=0.1)
    simulator.AdvanceTo(2.0)
    angles, _ = bend(level, simulator)
    roll = [joints.names.index(name) for name in SPINE_ROLL_JOINTS]
    assert np.all(angles[roll] > 0)
    assert angles.sum() == pytest.approx(0.4 * 0.1, rel=1e-6)
    np.testing.assert_allclose(np.delete(angles, roll), 0.0, atol=1e-12)


@pytest.mark.parametrize("lean", [{"forward": 0.1}, {"leftward": 0.1}])
def test_the_bend_moves_the_center_of_mass_against_the_lean(
    level: Any, plant: MultibodyPlant, joints: JointMap, lean: Any
) -> None:
    simulator = simulator_of(level, **lean)
    simulator.AdvanceTo(1.0)
    context = plant.CreateDefaultContext()
    before = plant.CalcCenterOfMassPositionInWorld(context)
    q = plant.GetPositions(context)
    q[joints.q] += bend(level, simulator)[0]
    plant.SetPositions(context, q)
    moved = plant.CalcCenterOfMassPositionInWorld(context) - before
    assert moved[0 if "forward" in lean else 1] < -1e-3


def test_angles_change_at_their_rates_until_the_next_update(level: UpperBodyBalance) -> None:
    simulator = simulator_of(level, forward=0.1, leftward=-0.05)
    for k in range(5):
        simulator.AdvanceTo((k + 0.5) * PERIOD)
        angles, rates = bend(level, simulator)
        alpha, alpha_rate = np.split(level.GetOutputPort("alpha").Eval(simulator.get_context()), 2)
        assert np.abs(rates).max() > 0
        simulator.AdvanceTo((k + 1.5) * PERIOD)
        np.testing.assert_allclose(bend(level, simulator)[0], angles + PERIOD * rates, atol=1e-12)
        now = level.GetOutputPort("alpha").Eval(simulator.get_context())[:2]
        np.testing.assert_allclose(now, alpha + PERIOD * alpha_rate, atol=1e-15)


def test_alpha_follows_with_its_time_constant(level: UpperBodyBalance) -> None:
    simulator = simulator_of(level, forward=0.1)
    simulator.AdvanceTo(PARAMETERS.time_constant + 0.5 * PERIOD)
    alpha = level.GetOutputPort("alpha").Eval(simulator.get_context())[0]
    assert alpha == pytest.approx(0.1 * (1 - np.exp(-1)), rel=0.05)


def test_a_body_without_a_spine_is_rejected() -> None:
    with pytest.raises(ValueError, match="Lumbar_6_Motion"):
        UpperBodyBalance(["Head_Motion"], PARAMETERS, PERIOD)
