"""A web page that sends what Meshcat cannot read ends the live view, and no more than that."""

from collections.abc import Callable

import pytest
from pydrake.geometry import Meshcat

from humanwalk.measures.signals import TIME
from humanwalk.run.fall_picture import show_fall
from humanwalk.run.live_view import is_lost
from humanwalk.run.simulate import prepare, simulate
from humanwalk.scenario import load_scenario
from humanwalk.view.replay import make_meshcat, static_page

SCENARIO = load_scenario("thesis", {"duration": "1"})


@pytest.fixture
def live() -> Meshcat:
    return make_meshcat(live=True)


def test_a_message_that_is_no_msgpack_ends_a_live_view(live: Meshcat, lose: Callable[[Meshcat], None]) -> None:
    assert not is_lost(live)
    lose(live)
    assert is_lost(live)


def test_a_walk_ends_as_interrupted_where_its_live_view_is_lost_and_keeps_signals_and_replay(
    live: Meshcat, lose: Callable[[Meshcat], None]
) -> None:
    recording = make_meshcat()

    def attack(time: float) -> None:
        if time == pytest.approx(0.1):
            lose(live)

    outcome = simulate(SCENARIO, recording, on_progress=attack, live=live)
    assert outcome.end == "interrupted"
    assert 0.1 <= outcome.signals[TIME][-1].as_py() < 0.2
    assert "recording" in static_page(recording)


def test_a_fall_is_kept_where_the_live_view_is_lost_before_the_body_lies(
    live: Meshcat, lose: Callable[[Meshcat], None]
) -> None:
    prepared = prepare(SCENARIO)
    assert prepared.plant is not None
    context = prepared.plant.GetMyContextFromRoot(prepared.simulator.get_context())
    lose(live)
    show_fall(SCENARIO, [live], 0.0, prepared.plant.GetPositionsAndVelocities(context), 0.0)
