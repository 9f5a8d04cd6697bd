"""The page that drives a walker: Meshcat's own sliders, buttons and gamepad."""

import math
from dataclasses import dataclass, field

from pydrake.geometry import Meshcat

from humanwalk.numerics.scalars import clip
from humanwalk.view.drive_server import Status
from humanwalk.walking.command import TESTED, Command


@dataclass(frozen=True)
class Slider:
    """A slider: its label, range, step and the keys that move it by a step."""

    label: str
    low: float
    high: float
    step: float
    decrement: str = ""
    increment: str = ""


def _speed(label: str, name: str, step: float, decrement: str, increment: str) -> Slider:
    """A slider over the tested range of a commanded speed."""
    _, ranges = TESTED[name]
    return Slider(label, min(low for low, _ in ranges), max(high for _, high in ranges), step, decrement, increment)


FORWARD = _speed("forward [m/s]", "forward", 0.1, "ArrowDown", "ArrowUp")
SIDEWAYS = _speed("left [m/s]", "sideways", 0.05, "KeyD", "KeyA")
TURN = _speed("turn left [rad/s]", "turn", 0.1, "ArrowRight", "ArrowLeft")
SPEEDS = (FORWARD, SIDEWAYS, TURN)

IMPULSE = Slider("push [N s]", 0.0, 100.0, 5.0, "Comma", "Period")
RATE = Slider("time rate", 0.1, 1.0, 0.1, "BracketLeft", "BracketRight")
FOLLOW = Slider("follow", 0.0, 1.0, 1.0)
RECORD = Slider("record", 0.0, 1.0, 1.0)
FIRST_IMPULSE = 30.0
"""The largest impulse that is survived from every side at 1.0 m/s [N s]: 40 of 40 in the study `balance_pushes`."""

FASTER, SLOWER, HALT = "faster (W)", "slower (S)", "stop walking (X)"
PAUSE, STEP, RESET = "pause or go on (space)", "one frame (N)", "reset (R)"
BUTTONS = {PAUSE: "Space", STEP: "KeyN", RESET: "KeyR"}
SPEED_BUTTONS = {FASTER: "KeyW", SLOWER: "KeyS", HALT: "KeyX"}

PUSHES = {
    "push forward (numpad 8)": ("Numpad8", 0.0),
    "push forward left (numpad 7)": ("Numpad7", 0.25 * math.pi),
    "push left (numpad 4)": ("Numpad4", 0.5 * math.pi),
    "push backward left (numpad 1)": ("Numpad1", 0.75 * math.pi),
    "push backward (numpad 2)": ("Numpad2", math.pi),
    "push backward right (numpad 3)": ("Numpad3", -0.75 * math.pi),
    "push right (numpad 6)": ("Numpad6", -0.5 * math.pi),
    "push forward right (numpad 9)": ("Numpad9", -0.25 * math.pi),
}
"""Key, and direction of the force relative to the walker's heading [rad]."""

GAMEPAD_BUTTONS = {12: "push forward (numpad 8)", 13: "push backward (numpad 2)"} | {
    14: "push left (numpad 4)",
    15: "push right (numpad 6)",
    9: PAUSE,
    8: RESET,
}
"""Buttons of a standard gamepad (W3C): directional pad, start, back."""
GAMEPAD_AXES = ((FORWARD, 1, -1.0), (SIDEWAYS, 0, -1.0), (TURN, 2, -1.0))
"""Slider, axis of the gamepad and its sign: left stick, and right stick sideways."""


START = Status(time=0.0, speed=0.0, factor=0.0, state="starting", ended=False, steers=False)


@dataclass(frozen=True)
class Hand:
    """What a hand does at the page.

    Attributes:
        target: commanded speeds; None if they have not changed since the last reading.
        pushes: directions of pushes relative to the heading [rad].
        impulse: of a push [N s].
        rate: simulated seconds per second.
        follow, record: whether the camera follows, and whether the walk is saved.
        pause, step, reset: whether the buttons were pressed.
    """

    target: Command | None
    pushes: tuple[float, ...]
    impulse: float
    rate: float
    follow: bool
    record: bool
    pause: bool
    step: bool
    reset: bool


@dataclass
class DrivePage:
    """Controls on a Meshcat page; all browsers that show it share them.

    Attributes:
        meshcat: The page.
        status: What `humanwalk.view.drive_server` shows beside them.
    """

    meshcat: Meshcat
    status: Status = field(default_factory=lambda: START)
    _clicks: dict[str, int] = field(default_factory=dict)
    _speeds: tuple[float, ...] = ()
    _sticks: tuple[float, ...] = ()
    _held: frozenset[int] = frozenset()

    def begin(self, target: Command | None, *, record: bool = True) -> None:
        """Add the controls, or reset the speeds to those that are commanded.

        Args:
            target: The commanded speeds; None if the walker follows no command.
            record: Whether the walk is saved unless the hand decides otherwise.
        """
        if not self._clicks:
            starts = {IMPULSE: FIRST_IMPULSE, RATE: 1.0, FOLLOW: 1.0, RECORD: float(record)}
            for slider in (*SPEEDS, *starts) if target is not None else starts:
                start = starts.get(slider, 0.0)
                add = self.meshcat.AddSlider
                add(slider.label, slider.low, slider.high, slider.step, start, slider.decrement, slider.increment)
            pushes = {name: key for name, (key, _) in PUSHES.items()}
            buttons = pushes | BUTTONS | (SPEED_BUTTONS if target is not None else {})
            for name, key in buttons.items():
                self.meshcat.AddButton(name, key)
            self._clicks = dict.fromkeys(buttons, 0)
        if target is not None:
            self.set_speeds(target)
        # What was pressed before does not count.
        self.read()

    def set_speeds(self, target: Command) -> None:
        """Move the sliders of the speeds to what is commanded."""
        for slider, speed in zip(SPEEDS, (target.forward, target.sideways, target.turn), strict=True):
            self._set(slider, speed)
        self._speeds = self._read_speeds()

    @property
    def watched(self) -> bool:
        """Whether a browser shows the page."""
        return self.meshcat.GetNumActiveConnections() > 0

    def read(self) -> Hand:
        """What was done since the last reading."""
        pressed = self._pressed()
        for name in pressed:
            self._change_speeds(name)
        return Hand(
            self._new_target(),
            tuple(PUSHES[name][1] for name in pressed if name in PUSHES),
            self._value(IMPULSE),
            self._value(RATE),
            self._value(FOLLOW) > 0.5,
            self._value(RECORD) > 0.5,
            PAUSE in pressed,
            STEP in pressed,
            RESET in pressed,
        )

    def show(self, time: float, speed: float, factor: float, state: str, *, ended: bool = False) -> None:
        """Show time [s], speed [m/s], real-time factor and what the walk is at or why it has ended."""
        steers = FASTER in self._clicks
        self.status = Status(time=time, speed=speed, factor=factor, state=state, ended=ended, steers=steers)

    def _pressed(self) -> list[str]:
        clicks = {name: self.meshcat.GetButtonClicks(name) for name in self._clicks}
        pressed = [name for name, count in clicks.items() for _ in range(count - self._clicks[name])]
        self._clicks = clicks
        held = self._gamepad_buttons()
        pressed += [name for button, name in GAMEPAD_BUTTONS.items() if button in held - self._held]
        self._held = held
        return pressed

    def _change_speeds(self, button: str) -> None:
        if button == HALT:
            for slider in SPEEDS:
                self._set(slider, 0.0)
        elif button in (FASTER, SLOWER):
            step = FORWARD.step if button == FASTER else -FORWARD.step
            self._set(FORWARD, self._value(FORWARD) + step)

    def _new_target(self) -> Command | None:
        if FASTER not in self._clicks:
            return None
        self._apply_sticks()
        speeds = self._read_speeds()
        if speeds == self._speeds:
            return None
        self._speeds = speeds
        return Command(*speeds)

    def _apply_sticks(self) -> None:
        """Move the sliders with the sticks of a gamepad that have moved."""
        axes = self.meshcat.GetGamepad().axes
        if len(axes) < 3:
            return
        sticks = []
        for slider, axis, sign in GAMEPAD_AXES:
            # Nor are sticks limited to theirs.
            share = sign * clip(axes[axis], -1.0, 1.0) if math.isfinite(axes[axis]) else 0.0
            speed = share * (slider.high if share > 0.0 else -slider.low)
            sticks.append(slider.step * round(speed / slider.step))
        for (slider, *_), stick, before in zip(GAMEPAD_AXES, sticks, self._sticks or (0.0, 0.0, 0.0), strict=True):
            if stick != before:
                self._set(slider, stick)
        self._sticks = tuple(sticks)

    def _gamepad_buttons(self) -> frozenset[int]:
        values = self.meshcat.GetGamepad().button_values
        return frozenset(number for number, value in enumerate(values) if value > 0.5)

    def _read_speeds(self) -> tuple[float, ...]:
        return tuple(self._value(slider) for slider in SPEEDS)

    def _value(self, slider: Slider) -> float:
        # What another page sends is not limited to the slider's range.
        value = self.meshcat.GetSliderValue(slider.label)
        return clip(value, slider.low, slider.high) if math.isfinite(value) else slider.low

    def _set(self, slider: Slider, value: float) -> None:
        self.meshcat.SetSliderValue(slider.label, clip(value, slider.low, slider.high))
