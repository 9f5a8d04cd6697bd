"""The picture of a run from its signals is that of the simulation."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.diagrams.replay import make_replay
from humanwalk.measures.signals import matrix
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import REPLAY, Run
from humanwalk.run.replayed import FORCES, show_run
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.systems.signal import state_columns
from humanwalk.view.replay import make_meshcat, read_recording
from humanwalk.view.replay_file import require_replay


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    overrides = {"duration": "0.3", "pushes.given": "[{time: 0.1, impulse: 5}]"}
    return simulate(load_scenario("thesis", overrides)).save(tmp_path_factory.mktemp("runs") / "short")


def test_the_scene_is_that_of_the_recorded_state(run: Run) -> None:
    state = matrix(run.signals, state_columns(JointMap.of(kinematics_plant(run.scenario.subject))))
    foot_forces = matrix(run.signals, FORCES["foot_forces"])
    replay = make_replay(run.scenario, run.time, state, {"foot_forces": foot_forces})
    context = replay.CreateDefaultContext()
    plant = kinematics_plant(run.scenario.subject)
    posture = plant.CreateDefaultContext()
    for row in (0, 17, run.time.size - 2):
        context.SetTime(run.time[row])
        scene: Any = replay.GetOutputPort("query_object").Eval(context)
        poses = {scene.inspector().GetName(f).rpartition("::")[2]: f for f in scene.inspector().GetAllFrameIds()}
        plant.SetPositionsAndVelocities(posture, state[row])
        for body in ("Pelvis", "Head", "LeftLeg_FootToes"):
            wanted = plant.GetBodyByName(body).EvalPoseInWorld(posture)
            assert scene.GetPoseInWorld(poses[body]).IsNearlyEqualTo(wanted, 1e-6)
        np.testing.assert_array_equal(replay.GetOutputPort("foot_forces").Eval(context), foot_forces[row])


def test_every_recorded_force_is_shown(run: Run) -> None:
    assert set().union(*FORCES.values()) <= set(run.signals.column_names)


def test_a_run_without_a_page_gets_one_from_its_signals_once(run: Run) -> None:
    assert not (run.path / REPLAY).exists()
    page = require_replay(run)
    assert page == run.replay
    assert len(read_recording(page).commands) > 50
    before = page.stat().st_mtime_ns
    assert require_replay(run) == page
    assert page.stat().st_mtime_ns == before


def test_a_single_sample_cannot_be_shown(tmp_path: Path) -> None:
    outcome = simulate(load_scenario("thesis", {"duration": "0.001", "recording.signal_period": "0.1"}))
    run = outcome.save(tmp_path / "one")
    assert run.time.size == 1
    with pytest.raises(ParameterError, match="one sample; allowed: two or more"):
        show_run(run, make_meshcat())
