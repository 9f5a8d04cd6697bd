"""The picture goes on after a fall; the run does not."""

import base64
import json

import pytest
from pydrake.geometry import Meshcat

from humanwalk.measures.signals import TIME
from humanwalk.run.fall_picture import TIME_TO_LIE, replay_duration
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.replay import RECORDING, make_meshcat, static_page

FRAME_RATE = 20.0


@pytest.fixture(scope="module")
def meshcat() -> Meshcat:
    return make_meshcat()


def test_picture_lasts_until_the_body_lies_and_the_record_ends_at_the_fall(meshcat: Meshcat) -> None:
    overrides = {
        "duration": "2",
        "recording.frame_rate": str(FRAME_RATE),
        "pushes": "{given: [{time: 0.0, duration: 0.05, impulse: 400.0, direction: 1.57}]}",
    }
    outcome = simulate(load_scenario("stand", overrides), meshcat)
    end = outcome.signals[TIME][-1].as_py()
    assert outcome.end == "fell"
    assert end < 1.0
    duration = replay_duration(outcome.summary())
    assert duration == end + TIME_TO_LIE
    commands = json.loads(RECORDING.findall(static_page(meshcat))[0])
    (animation,) = [command for command in map(base64.b64decode, commands) if b"set_animation" in command]
    pelvis = animation.partition(b"/drake/visualizer/human/Pelvis")[2].partition(b"path")[0]
    last_frame, one_more = (b"\xa4time" + bytes([int(duration * FRAME_RATE) + more]) for more in (0, 1))
    assert last_frame in pelvis
    assert one_more not in pelvis
