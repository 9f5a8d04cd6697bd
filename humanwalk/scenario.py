"""The scenario: who walks, how, on what and for how long. One dataclass is the file format; every default is valid.

A file names only what differs from the defaults:

    description: The thesis' walk with a lower step
    controller: {thesis: {gait: {path: {step_height: 0.12}}}}

Terrain, contact, controller and actuation are choices: the tag alone (`contact: hydroelastic`), or the tag with fields
of its own. Units are SI throughout: meters, seconds, radians, newtons, kilograms.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from humanwalk.body.subject import Subject
from humanwalk.choices import (
    ACTUATIONS,
    CONTACTS,
    CONTROLLERS,
    Actuation,
    Contact,
    Controller,
    PdActuation,
    PointContact,
    ThesisController,
)
from humanwalk.choices.start import StartParameters
from humanwalk.notebook import html_table
from humanwalk.parameter_file import anchor_paths, build, dump, located, read_fields, require_valid
from humanwalk.parameter_override import override
from humanwalk.quantity import ParameterError, choice, quantity, require_kind, tag_of
from humanwalk.shipped_files import named_file, shipped_files
from humanwalk.terrain import TERRAINS, Plane, Terrain
from humanwalk.walking.push import PushParameters
from humanwalk.yaml_text import read_yaml


@dataclass(frozen=True)
class SimulationParameters:
    """How time advances."""

    integrator: Literal["discrete", "cenic"] = "discrete"
    """Fixed steps of `time_step`, or Drake's error-controlled convex integrator (then time_step must be 0)."""

    time_step: float = quantity(0.002, "s", 0.0, 0.01)
    """Step of the discrete plant; docs/performance.md compares accuracy and cost."""

    contact_approximation: Literal["sap", "lagged", "similar"] = "lagged"
    """Drake's convex approximation of contact in the discrete plant. `lagged` is Drake's default; heel strikes with
    `sap` are four times as hard."""

    accuracy: float = quantity(1e-3, "", 1e-8, 0.1)
    """Accuracy of cenic."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a step that does not fit the integrator."""
        if self.integrator == "cenic" and self.time_step != 0:
            raise ParameterError(
                f"time_step: {self.time_step:g} does not fit integrator cenic; allowed: 0; set time_step: 0, or "
                "integrator: discrete"
            )
        if self.integrator == "discrete" and not self.time_step >= MIN_TIME_STEP:
            raise ParameterError(
                f"time_step: {self.time_step:g} is out of range with integrator discrete; allowed: {MIN_TIME_STEP:g} "
                "to 0.01 s; set time_step: 0.002, or integrator: cenic and time_step: 0"
            )


MIN_TIME_STEP = 1e-5
"""Smallest step of the discrete plant [s]: a second takes an hour."""


@dataclass(frozen=True)
class RecordingParameters:
    """What is kept of a run."""

    signal_period: float = quantity(0.01, "s", 0.0005, 0.1)
    """Time between two rows of the signals: 100 Hz, as gait laboratories record motion. A row costs half a millisecond;
    0.002 s shows every step of the plant, and the ground force of a heel strike as a force plate does."""

    frame_rate: float = quantity(32.0, "1/s", 1.0, 240.0)
    """Frames per second of the replay."""


@dataclass(frozen=True, repr=False)
class Scenario:
    """Everything a run depends on."""

    description: str = ""
    """One line for people."""

    duration: float = quantity(15.0, "s", 0.001, 3600.0)
    """Simulated time; the thesis runs 15 s."""

    seed: int = quantity(0, "", 0, 2**32 - 1)
    """Of everything random."""

    subject: Subject = Subject()
    """Whose body."""

    terrain: Terrain = choice(TERRAINS, Plane())
    """The ground."""

    contact: Contact = choice(CONTACTS, PointContact())
    """Contact of feet and ground."""

    controller: Controller = choice(CONTROLLERS, ThesisController())
    """How the body walks: `thesis` and `recorded` assume balance, `balanced` has no external force."""

    actuation: Actuation = choice(ACTUATIONS, PdActuation())
    """How a command becomes torque."""

    pushes: PushParameters = PushParameters()
    """Pushes against the body."""

    start: StartParameters = StartParameters()
    simulation: SimulationParameters = SimulationParameters()
    recording: RecordingParameters = RecordingParameters()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is allowed but may surprise, one line each: speeds that were not tested, and pushes after the end."""
        late = [push.time for push in self.pushes.given if push.time >= self.duration]
        after = [f"pushes.given: the push at {time:g} s comes after the end at {self.duration:g} s" for time in late]
        return tuple(dict.fromkeys((*self.controller.untested, *after)))

    def __repr__(self) -> str:
        """Description, duration and choices; `dump_scenario` has every field."""
        return f"Scenario({', '.join(f'{name} {value}' for name, value in self._rows())})"

    def _repr_html_(self) -> str:
        return html_table("Scenario", self._rows())

    def _rows(self) -> list[tuple[str, str]]:
        choices: dict[str, Mapping[str, type[Any]]]
        choices = {"terrain": TERRAINS, "contact": CONTACTS, "controller": CONTROLLERS, "actuation": ACTUATIONS}
        return [
            ("description", repr(self.description)),
            ("duration", f"{self.duration:g} s"),
            ("subject", str(self.subject)),
            *((name, tag_of(tags, getattr(self, name))) for name, tags in choices.items()),
        ]


def require_scenario(value: object, function: str) -> None:
    """Raise ParameterError unless a function was called with a Scenario that a file may hold."""
    require_kind(value, Scenario, function, 'load_scenario("thesis")')
    require_valid(value)


def shipped_scenarios() -> dict[str, Path]:
    """Files of the scenarios that come with humanwalk, by name."""
    return shipped_files("scenarios")


def load_scenario(name_or_path: str | Path, overrides: Mapping[str, Any] | None = None) -> Scenario:
    """Load a shipped scenario by name, or any scenario by the path of its file.

    Args:
        name_or_path: "thesis", or a YAML file.
        overrides: values to replace by dotted field name, as YAML text or as they are, e.g.
            {"controller.thesis.gait.path.step_height": "0.12", "duration": 3}.

    Raises:
        ParameterError: no such scenario, not a scenario, or a value that cannot be used; one line.
    """
    path = named_file("scenario", name_or_path, shipped_scenarios())
    return parse_scenario(read_fields(path), overrides, name=path.name, folder=path.parent)


def parse_scenario(
    text: str, overrides: Mapping[str, Any] | None = None, name: str = "scenario", folder: Path = Path()
) -> Scenario:
    """Scenario from YAML text; see `load_scenario`.

    Relative paths in the text count from `folder`, those in overrides from the working directory.
    """
    if not isinstance(overrides, Mapping | None):
        raise ParameterError(f'overrides: {overrides!r} is no mapping; allowed: {{"duration": 3}}; name the fields')
    data = read_yaml(text, name)
    anchor_paths(Scenario, data, folder)
    for field, value in (overrides or {}).items():
        override(Scenario, data, field, value)
    with located(text, name, overrides or ()):
        return build(Scenario, data)


def dump_scenario(scenario: Scenario) -> str:
    """The complete scenario as YAML, every field written out; `parse_scenario` reads it back to an equal one."""
    return dump(scenario)
