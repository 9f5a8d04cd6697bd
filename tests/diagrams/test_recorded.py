"""Playback and walker that follow a recording."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.body.joint_map import JointMap
from humanwalk.body.limbs import LEGS
from humanwalk.body.opensim_names import COORDINATES
from humanwalk.diagrams.playback import make_playback
from humanwalk.diagrams.walker import make_walker
from humanwalk.motion.followed import REQUIRED_JOINTS
from humanwalk.motion.motion_table import MotionTable, storage_text
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario

TIME = np.arange(0, 1.001, 0.02)


@pytest.fixture
def squat_file(tmp_path: Path) -> Path:
    """Hips, knees and ankles bend together, so that the soles stay level; OpenSim's names, degrees."""
    bend = np.rad2deg(0.6 * np.sin(0.5 * np.pi * TIME) ** 2)
    columns = {COORDINATES[name][0]: np.zeros_like(TIME) for name in REQUIRED_JOINTS}
    for side in "rl":
        columns |= {f"hip_flexion_{side}": bend, f"knee_angle_{side}": 2 * bend, f"ankle_angle_{side}": bend}
    table = MotionTable(tuple(columns), TIME, np.column_stack(list(columns.values())), True)
    (tmp_path / "squat.mot").write_text(storage_text("t", table))
    return tmp_path / "squat.mot"


def following(path: Path, **changes: Any) -> Scenario:
    return load_scenario("thesis", {"controller": f"{{recorded: {{angles: {path}}}}}"} | changes)


def test_balance_levels_do_not_go_with_a_recording(squat_file: Path) -> None:
    with pytest.raises(ParameterError, match=r"controller\.thesis|controller is"):
        following(squat_file, **{"controller.thesis.balance.upper_body.enabled": "true"})


def test_playback_shows_the_recording_exactly(squat_file: Path, joints: JointMap) -> None:
    scenario = following(squat_file)
    playback = make_playback(scenario)
    motion = scenario.controller.motion(scenario.subject, scenario.terrain)  # type: ignore[attr-defined]
    context = playback.CreateDefaultContext()
    context.SetTime(0.8)
    angles, _ = motion.joints(0.8)
    np.testing.assert_allclose(playback.GetOutputPort("state").Eval(context)[joints.q], angles, atol=1e-12)


def test_walker_follows_the_recording_with_the_support(squat_file: Path, joints: Any) -> None:
    """Through the PD bank, against gravity: half a second of bending the knees."""
    scenario = following(squat_file)
    walker = make_walker(scenario)
    simulator = Simulator(walker)
    simulator.AdvanceTo(0.6)
    context = simulator.get_context()
    state = walker.GetOutputPort("state").Eval(context)
    wanted, _ = scenario.controller.motion(scenario.subject, scenario.terrain).joints(0.6)  # type: ignore[attr-defined]
    assert wanted[joints.names.index(LEGS["Right"].knee)] > 0.3
    np.testing.assert_allclose(joints.positions(state), wanted, atol=0.05)
    np.testing.assert_allclose(state[4:7], walker.GetOutputPort("pelvis_reference").Eval(context)[4:7], atol=0.03)
    np.testing.assert_allclose(walker.GetOutputPort("desired_state").Eval(context)[:42], wanted, atol=1e-9)
