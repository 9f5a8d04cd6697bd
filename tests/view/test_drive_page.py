"""The controls of the page: what a browser sends becomes speeds, pushes and switches."""

import math
import struct
from typing import Any

import pytest

from humanwalk.view.drive_page import (
    FASTER,
    FOLLOW,
    FORWARD,
    HALT,
    IMPULSE,
    PAUSE,
    PUSHES,
    RATE,
    RECORD,
    RESET,
    SIDEWAYS,
    SLOWER,
    STEP,
    TURN,
    DrivePage,
)
from humanwalk.view.replay import make_meshcat
from humanwalk.walking.command import Command

START = Command(forward=1.0)


def packed(value: Any) -> bytes:
    """A value as msgpack, which browsers send to Meshcat."""
    if isinstance(value, dict):
        return bytes([0x80 + len(value)]) + b"".join(packed(key) + packed(item) for key, item in value.items())
    if isinstance(value, list):
        return bytes([0xDC, 0, len(value)]) + b"".join(map(packed, value))
    if isinstance(value, str):
        return bytes([0xD9, len(value)]) + value.encode()
    return bytes([value]) if isinstance(value, int) else b"\xcb" + struct.pack(">d", value)


class Browser:
    """Sends what Meshcat's page sends."""

    def __init__(self, page: DrivePage) -> None:
        self.meshcat: Any = page.meshcat

    def press(self, button: str) -> None:
        self.send(type="button", name=button)

    def slide(self, slider: Any, value: float) -> None:
        self.send(type="slider", name=slider.label, value=value)

    def hold(self, axes: list[float], buttons: list[float]) -> None:
        self.send(type="gamepad", name="", gamepad={"index": 0, "button_values": buttons, "axes": axes})

    def send(self, **message: Any) -> None:
        self.meshcat._InjectWebsocketMessage(message=packed(message))


@pytest.fixture
def page() -> DrivePage:
    page = DrivePage(make_meshcat())
    page.begin(START)
    return page


@pytest.fixture
def browser(page: DrivePage) -> Browser:
    return Browser(page)


def test_at_first_nothing_is_changed(page: DrivePage) -> None:
    hand = page.read()
    assert hand.target is None
    assert hand.pushes == ()
    assert (hand.pause, hand.step, hand.reset, hand.follow, hand.record) == (False, False, False, True, True)
    assert hand.rate == 1.0
    assert page.meshcat.GetSliderValue(FORWARD.label) == 1.0


def test_sliders_command_speeds_once(page: DrivePage, browser: Browser) -> None:
    browser.slide(FORWARD, 0.6)
    browser.slide(TURN, -0.3)
    target = page.read().target
    assert (target.forward, target.sideways, target.turn) == pytest.approx((0.6, 0.0, -0.3))
    assert page.read().target is None


@pytest.mark.parametrize("value", [1e9, -1e9, math.inf, math.nan])
def test_a_slider_sends_nothing_beyond_its_range(page: DrivePage, browser: Browser, value: float) -> None:
    for slider in (FORWARD, SIDEWAYS, TURN, RATE, IMPULSE):
        browser.slide(slider, value)
    hand = page.read()
    assert FORWARD.low <= hand.target.forward <= FORWARD.high
    assert SIDEWAYS.low <= hand.target.sideways <= SIDEWAYS.high
    assert TURN.low <= hand.target.turn <= TURN.high
    assert RATE.low <= hand.rate <= RATE.high
    assert IMPULSE.low <= hand.impulse <= IMPULSE.high


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_stick_that_is_nowhere_rests(page: DrivePage, browser: Browser, value: float) -> None:
    browser.hold([value] * 3, [])
    assert page.read().target is None


def test_a_stick_sends_nothing_beyond_its_range(page: DrivePage, browser: Browser) -> None:
    browser.hold([-1e308] * 3, [])
    assert page.read().target == Command(FORWARD.high, SIDEWAYS.high, TURN.high)


def test_buttons_change_the_speed_by_steps_and_stop(page: DrivePage, browser: Browser) -> None:
    for button in (FASTER, FASTER, SLOWER):
        browser.press(button)
    assert page.read().target.forward == pytest.approx(1.1)
    browser.press(HALT)
    assert page.read().target == Command()


@pytest.mark.parametrize(("button", "bearing"), [(name, bearing) for name, (_, bearing) in PUSHES.items()])
def test_a_button_pushes_once_in_its_direction(page: DrivePage, browser: Browser, button: str, bearing: float) -> None:
    browser.slide(IMPULSE, 45.0)
    browser.press(button)
    hand = page.read()
    assert (hand.pushes, hand.impulse) == ((bearing,), 45.0)
    assert page.read().pushes == ()


def test_pushes_come_from_eight_directions() -> None:
    bearings = sorted(bearing for _, bearing in PUSHES.values())
    assert bearings == pytest.approx([math.pi * (i / 4 - 0.75) for i in range(8)])


@pytest.mark.parametrize(("button", "field"), [(PAUSE, "pause"), (STEP, "step"), (RESET, "reset")])
def test_a_button_is_pressed_until_it_is_read(page: DrivePage, browser: Browser, button: str, field: str) -> None:
    browser.press(button)
    assert getattr(page.read(), field) is True
    assert getattr(page.read(), field) is False


@pytest.mark.parametrize(("slider", "field"), [(FOLLOW, "follow"), (RECORD, "record")])
def test_switches(page: DrivePage, browser: Browser, slider: Any, field: str) -> None:
    browser.slide(slider, 0.0)
    assert getattr(page.read(), field) is False


def test_a_gamepad_moves_the_sliders_and_pushes(page: DrivePage, browser: Browser) -> None:
    released = [0.0] * 17
    browser.hold([0.0, -1.0, 0.5, 0.0], released)
    target = page.read().target
    assert (target.forward, target.sideways, target.turn) == pytest.approx((FORWARD.high, 0.0, -0.2))
    pressed = [float(button == 14) for button in range(17)]
    browser.hold([0.0, -1.0, 0.5, 0.0], pressed)
    hand = page.read()
    assert (hand.target, hand.pushes) == (None, (0.5 * math.pi,))
    # A button that is held down pushes once.
    assert page.read().pushes == ()
    # A stick that rests leaves the sliders to the mouse.
    browser.hold([0.0, 0.0, 0.0, 0.0], released)
    assert page.read().target == Command()
    browser.slide(FORWARD, 0.5)
    assert page.read().target.forward == pytest.approx(0.5)


def test_the_scenario_moves_the_sliders_without_commanding(page: DrivePage) -> None:
    page.set_speeds(Command(forward=0.33, sideways=-0.2))
    assert page.read().target is None
    assert page.meshcat.GetSliderValue(SIDEWAYS.label) == pytest.approx(-0.2)


def test_what_was_pressed_before_a_reset_does_not_count(page: DrivePage, browser: Browser) -> None:
    browser.press(PAUSE)
    browser.slide(FORWARD, 0.2)
    page.begin(START)
    hand = page.read()
    assert (hand.pause, hand.target) == (False, None)
    assert page.meshcat.GetSliderValue(FORWARD.label) == 1.0


def test_a_walker_without_command_has_no_sliders_of_speed() -> None:
    page = DrivePage(make_meshcat())
    page.begin(None)
    assert not {FORWARD.label, SIDEWAYS.label, TURN.label} & set(page.meshcat.GetSliderNames())
    assert page.read().target is None


def test_the_page_keeps_what_it_shows(page: DrivePage) -> None:
    page.show(1.5, 0.98, 0.5, "left swing, 20 %")
    assert page.status == {
        **{"time": 1.5, "speed": 0.98, "factor": 0.5, "state": "left swing, 20 %"},
        **{"ended": False, "steers": True},
    }
    page.show(2.0, 0.0, 0.0, "fell; reset with R", ended=True)
    assert page.status["ended"] is True
