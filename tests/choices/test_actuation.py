"""The actuations beside PD: wired into every walker, recorded, reproducible, refused in one line."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.body.joint_map import JointMap
from humanwalk.body.opensim_names import COORDINATES
from humanwalk.diagrams.walker import make_walker
from humanwalk.measures.signals import matrix, unit_of
from humanwalk.motion.followed import REQUIRED_JOINTS
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.quantity import ParameterError
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, load_scenario

COLUMNS = {"pid": ("integral_torque_N_m",), "adaptive": ("estimated_inertia_kg_m2", "estimated_load_N_m")}


def scenario(tmp_path: Path, walker: str, actuation: str, **more: str) -> Scenario:
    """A shipped scenario, or a recording of standing still, with an actuation."""
    changes = {"actuation": actuation} | more
    if walker == "recorded":
        columns = [COORDINATES[name][0] for name in REQUIRED_JOINTS]
        still = MotionTable(tuple(columns), np.array([0.0, 1.0]), np.zeros((2, len(columns))), in_degrees=True)
        (tmp_path / "still.mot").write_text(storage_text("still", still))
        changes["controller"] = f"{{recorded: {{angles: {tmp_path / 'still.mot'}}}}}"
    return load_scenario("stand" if walker == "stand" else "thesis", changes)


@pytest.mark.parametrize("walker", ["thesis", "stand", "recorded"])
@pytest.mark.parametrize("actuation", COLUMNS)
def test_every_controller_works_with_it_and_its_state_is_recorded(
    tmp_path: Path, joints: JointMap, walker: str, actuation: str
) -> None:
    outcome = simulate(scenario(tmp_path, walker, actuation, duration="0.1"))
    assert outcome.end == "completed"
    assert np.abs(matrix(outcome.signals, [f"{joint}.{COLUMNS[actuation][-1]}" for joint in joints.names])).max() > 0
    for what in COLUMNS[actuation]:
        names = [f"{joint}.{what}" for joint in joints.names]
        values = matrix(outcome.signals, names)
        assert np.isfinite(values).all()
        np.testing.assert_array_equal(values[0], 0.0)
        # Without motion there is no inertia to estimate.
        assert walker != "thesis" or np.abs(values[-1]).max() > 0
        assert unit_of(names[0]) == {"inertia_kg_m2": "kg m2"}.get(what.partition("_")[2], "N m")


@pytest.mark.parametrize("actuation", COLUMNS)
def test_the_balanced_walker_corrects_only_the_joints_that_it_holds(tmp_path: Path, actuation: str) -> None:
    """The whole-body program moves the others by torque; there is no stiffness to which gains could be related."""
    case = scenario(tmp_path, "stand", actuation, duration="0.1")
    diagram = make_walker(case)
    model = diagram.GetSubsystemByName("plant")
    kp, _ = case.controller.actuator_gains(case.subject)
    what = COLUMNS[actuation][-1]
    values = matrix(simulate(case).signals, [f"{name}.{what}" for name in JointMap.of(model).names])
    np.testing.assert_array_equal(values[:, kp == 0], 0.0)
    assert 0 < np.count_nonzero(values[-1]) <= np.count_nonzero(kp) < 42


@pytest.mark.parametrize("actuation", COLUMNS)
def test_the_same_scenario_gives_the_same_bits(tmp_path: Path, actuation: str) -> None:
    noisy = {"duration": "0.1", "start.joint_noise": "0.01", "start.gain_noise": "0.05", "seed": "3"}
    first, again = (simulate(scenario(tmp_path, "thesis", actuation, **noisy)).signals for _ in range(2))
    assert first.equals(again)


@pytest.mark.parametrize("actuation", COLUMNS)
def test_the_torque_with_it_keeps_the_effort_limits(tmp_path: Path, joints: JointMap, actuation: str) -> None:
    text = f"{{{actuation}: {{effort_limits: human, law: implicit}}}}"
    every_step = {"recording.signal_period": "0.002", "controller.thesis.gait.ramp.duration": "0.1"}
    signals = simulate(scenario(tmp_path, "thesis", text, duration="0.2", **every_step)).signals
    share = np.abs(matrix(signals, [f"{name}.torque_N_m" for name in joints.names])) / joints.effort_limits
    assert share.max() == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("actuation", "more", "begin"),
    [
        ("{pid: {integral_time: 0.01}}", {}, r"actuation\.pid\.integral_time: 0\.01 is unstable at time_step"),
        ("{pid: {law: explicit}}", {}, r"actuation\.pid\.law: explicit is unstable at time_step"),
        ("{adaptive: {law: explicit}}", {}, r"actuation\.adaptive\.law: explicit is unstable at time_step"),
        ("{adaptive: {adaptation_time: 0.02}}", {}, r"actuation\.adaptive\.adaptation_time: 0\.02 is unstable at time"),
        ("{adaptive: {error_rate: 90}}", {}, r"actuation\.adaptive\.error_rate: 90 is not smaller than kd over the"),
        (
            "pid",
            {"simulation": "{integrator: cenic, time_step: 0}"},
            r"actuation\.pid\.integral_time: an integral needs",
        ),
        (
            "adaptive",
            {"simulation": "{integrator: cenic, time_step: 0}"},
            r"actuation\.adaptive\.adaptation_time: an i",
        ),
    ],
)
def test_what_cannot_be_simulated_is_refused_in_one_line(
    tmp_path: Path, actuation: str, more: dict[str, Any], begin: str
) -> None:
    with pytest.raises(ParameterError) as refused:
        make_walker(scenario(tmp_path, "thesis", actuation, **more))
    message = str(refused.value)
    assert re.match(begin, message)
    assert "; allowed: " in message
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize(
    ("actuation", "field", "value"),
    [("pid", "integral_time", "0.01"), ("adaptive", "adaptation_time", "0.01"), ("adaptive", "error_rate", "99")],
)
def test_the_value_that_the_refusal_names_works(tmp_path: Path, actuation: str, field: str, value: str) -> None:
    def make(value: str) -> None:
        make_walker(scenario(tmp_path, "thesis", f"{{{actuation}: {{{field}: {value}}}}}"))

    with pytest.raises(ParameterError) as refused:
        make(value)
    limit, _, after = str(refused.value).partition("allowed: ")[2].removeprefix("below ").partition(" ")
    make(limit if after.startswith("s or longer") else str(float(limit) - 0.1))
