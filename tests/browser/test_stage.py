from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap
from humanwalk.body.plant import kinematics_plant
from humanwalk.measures.signals import TIME, matrix
from humanwalk.systems.signal import state_columns
from humanwalk.view.browser import open_stage
from humanwalk.view.views import VIEWS, Camera, camera

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 160, 120
FRAME_TIMES = (0.12, 0.36)
"""Times of frames, at 50 per second, at which signals, at 100 per second, are recorded too [s]."""


@pytest.fixture(scope="module")
def stage(short_run: Any, loop: Any) -> Iterator[Any]:
    opening = open_stage(short_run.replay, WIDTH, HEIGHT, short_run.summary["duration_s"])
    yield loop.run(opening.__aenter__())
    loop.run(opening.__aexit__(None, None, None))


def states(run: Any, plant: MultibodyPlant, joints: JointMap, time: Any) -> Any:
    signals = run.signals
    (row,) = np.flatnonzero(np.isclose(signals[TIME].to_numpy(), time, rtol=0.0, atol=1e-9))
    return matrix(signals, state_columns(joints))[row][: plant.num_positions()]


@pytest.mark.parametrize("time", FRAME_TIMES)
@pytest.mark.parametrize("body", ["Pelvis", "Head", "RightLeg_FootToes", "LeftLeg_Ankle", "LeftArm_Hand"])
def test_a_frame_shows_the_recorded_pose_of_every_body(
    stage: Any, loop: Any, short_run: Any, joints: JointMap, time: Any, body: Any
) -> None:
    plant = kinematics_plant(short_run.scenario.subject)
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, states(short_run, plant, joints, time))
    expected = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(body)).GetAsMatrix4()
    shown = np.reshape(loop.run(stage.pose(time, body)), (4, 4)).T
    np.testing.assert_allclose(shown, expected, rtol=0.0, atol=1e-6)


def test_the_page_logs_no_error_and_requests_nothing(stage: Any, loop: Any) -> None:
    loop.run(stage.still(0.1, camera("follow", 0.1)))
    assert stage.complaints == []


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_shows_the_walker_before_the_sky(stage: Any, loop: Any, tmp_path: Path, view: Any) -> None:
    def pixels(look: Any) -> Any:
        path = tmp_path / "still.png"
        path.write_bytes(loop.run(stage.still(0.25, look, "png")))
        return np.asarray(Image.open(path).convert("RGB"), dtype=float)

    sky_only = pixels(Camera((0.0, -4.7, 30.0), (0.0, 0.0, 60.0)))
    picture = pixels(camera(view, 0.25))
    assert picture.shape == (HEIGHT, WIDTH, 3)
    middle = picture[HEIGHT // 4 : -HEIGHT // 4, WIDTH // 2 - 6 : WIDTH // 2 + 6]
    assert np.abs(middle - sky_only[HEIGHT // 4 : -HEIGHT // 4, WIDTH // 2 - 6 : WIDTH // 2 + 6]).mean() > 20.0


@pytest.mark.parametrize(("time", "loaded"), [(0.2, True), (0.4, False)])
def test_force_arrows_are_drawn_over_the_body(stage: Any, loop: Any, tmp_path: Path, time: Any, loaded: Any) -> None:
    """As in the page: the line of action of the force runs inside the leg. At 0.4 s no foot is loaded."""
    (tmp_path / "still.png").write_bytes(loop.run(stage.still(time, camera("side", time), "png")))
    with Image.open(tmp_path / "still.png") as still:
        red, green, blue = np.moveaxis(np.asarray(still.convert("RGB"), dtype=float), -1, 0)
    arrow = (red > 120) & (green < 0.35 * red) & (blue < 0.35 * red)
    assert bool(arrow.sum() > 10) is loaded
