"""The scenario: who walks, how, on what and for how long. One dataclass is the file format; every default is valid.

A file names only what differs from the defaults:

    description: The thesis' walk with a lower step
    gait:
      path: {step_height: 0.12}

Units are SI throughout: metres, seconds, radians, newtons, kilograms.
"""

import dataclasses
import difflib
import math
import reprlib
import typing
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any, Literal

import yaml
from pydrake.common.yaml import yaml_dump, yaml_load

from humanwalk.body.plant import Subject
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.control.balance_levels import FootForceBalanceParameters, UpperBodyBalanceParameters
from humanwalk.control.balance_support import BalanceSupportParameters
from humanwalk.control.inverse_kinematics import InverseKinematicsParameters
from humanwalk.control.pd_control import ActuatorParameters
from humanwalk.control.whole_body_parameters import WholeBodyParameters
from humanwalk.gait.arm_swing import ArmSwingParameters
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.quantity import ParameterError, check, quantity, require_in_range
from humanwalk.walking.command import CommandParameters
from humanwalk.walking.parameters import StepPlannerParameters
from humanwalk.walking.push import PushParameters

Contact = Literal["point", "hydroelastic", "asperity"]
Controller = Literal["thesis", "balanced"]

LARGEST_FILE = 100_000
"""Of a scenario [bytes]; a complete one has two thousand, and a parser may need thousands of times a file's size."""

_BRIEF = reprlib.Repr(maxlevel=3, maxlist=4, maxdict=4, maxset=4, maxstring=60, maxlong=60, maxother=60)


@dataclass(frozen=True)
class GaitParameters:
    """The walk that is asked for."""

    ramp: SpeedRamp = SpeedRamp()
    """Speed of the pelvis over time."""

    path: FootPathParameters = FootPathParameters()
    """Path of each foot."""

    first_swing: Literal["Right", "Left"] = "Right"
    """Leg that swings first."""

    arms: ArmSwingParameters = ArmSwingParameters()
    """Swing of the arms."""


@dataclass(frozen=True)
class StartParameters:
    """The body at time zero: standing still above the origin, facing +x."""

    joint_angles: dict[str, float] = field(default_factory=dict)
    """Angles [rad] by joint name; every other joint stands at its desired angle."""

    pelvis_lift: float = quantity(0.0, "m", -0.002, 0.5)
    """Height of the pelvis above the one at which the soles touch the ground; deeper the contact would explode."""

    joint_noise: float = quantity(0.0, "rad", 0.0, 0.2)
    """Standard deviation of a random error of every joint angle, drawn from the scenario's seed."""

    rate_noise: float = quantity(0.0, "rad/s", 0.0, 2.0)
    """Standard deviation of a random rate of every joint, drawn from the seed; the pelvis is at rest."""

    gain_noise: float = quantity(0.0, "", 0.0, 0.5)
    """Standard deviation of the logarithm of a random factor on every gain, drawn from the seed: kp and kd of each
    actuator; stiffness and damping of each task of the walker on its own feet. It lasts for the whole run."""


@dataclass(frozen=True)
class BalanceParameters:
    """What keeps the body upright."""

    support: BalanceSupportParameters = BalanceSupportParameters()
    """The assumed balance: a spring-damper on the pelvis."""

    foot_force: FootForceBalanceParameters = FootForceBalanceParameters()
    """Level 1 of the thesis."""

    upper_body: UpperBodyBalanceParameters = UpperBodyBalanceParameters()
    """Level 2 of the thesis."""


@dataclass(frozen=True)
class BalancedWalkParameters:
    """The walk without external force; counts with `controller: balanced`."""

    command: CommandParameters = CommandParameters()
    """Speed and heading over time."""

    planner: StepPlannerParameters = StepPlannerParameters()
    """Steps and balance."""

    whole_body: WholeBodyParameters = WholeBodyParameters()
    """Joint torques."""

    joint_damping: float = quantity(1.0, "N m s/rad", 0.0, 100.0)
    """Damping of every joint towards the planned rate, by the plant's implicit law."""

    foot_stiffness: float = quantity(500.0, "N m/rad", 0.0, 1e5)
    """Stiffness of ankle twist, mid-foot and toes, which the planner does not steer."""

    foot_damping: float = quantity(10.0, "N m s/rad", 0.0, 1e3)
    """Damping of the same."""

    control_period: float = quantity(0.004, "s", 0.001, 0.01)
    """Time between two plans and solutions."""

    leg_contact: bool = True
    """Whether one leg stops the other; else they pass through each other."""


@dataclass(frozen=True)
class FollowParameters:
    """A recording whose joint angles are followed instead of the gait's."""

    file: str = ""
    """A .mot, .sto or .csv file with joint angles, beside the scenario's if not elsewhere; none: the gait is walked."""

    mapping: str = ""
    """A YAML file, beside the scenario's as well, that says which column is which joint and in what unit
    (`MotionMapping`); none: by name."""

    kinematic: bool = False
    """Show the recording as it is, without physics: no forces, no torques, no balance."""

    ease_in: float = quantity(0.3, "s", 0.0, 5.0)
    """Time over which the recording gets up to speed, since the body starts at rest."""


@dataclass(frozen=True)
class SimulationParameters:
    """How time advances."""

    integrator: Literal["discrete", "cenic"] = "discrete"
    """Fixed steps of `time_step`, or Drake's error-controlled convex integrator (then time_step must be 0)."""

    time_step: float = quantity(0.001, "s", 0.0, 0.01)
    """Step of the discrete plant."""

    contact_approximation: Literal["sap", "lagged", "similar"] = "lagged"
    """Drake's convex approximation of contact in the discrete plant. `lagged` is Drake's default; `sap` is a little
    quicker, and its heel strikes four times as hard."""

    accuracy: float = quantity(1e-3, "", 1e-8, 0.1)
    """Accuracy asked of cenic."""

    control_period: float = quantity(0.01, "s", 0.0005, 0.05)
    """Time between two solutions of the inverse kinematics; 0.01 s is the thesis' time between two foot points."""


@dataclass(frozen=True)
class RecordingParameters:
    """What is kept of a run."""

    signal_period: float = quantity(0.005, "s", 0.0005, 0.1)
    """Time between two rows of the signals."""

    frame_rate: float = quantity(32.0, "1/s", 1.0, 240.0)
    """Frames per second of the replay."""


@dataclass(frozen=True)
class Scenario:
    """Everything a run depends on."""

    description: str = ""
    """One line for people."""

    duration: float = quantity(15.0, "s", 0.001, 3600.0)
    """Simulated time; the thesis runs 15 s."""

    seed: int = quantity(0, "", 0, 2**32 - 1)
    """Of everything random."""

    contact: Contact = "point"
    """Contact model under the feet: Drake's point or hydroelastic contact, or the thesis' law."""

    asperity: AsperityParameters = AsperityParameters()
    """The thesis' law; counts with `contact: asperity`."""

    subject: Subject = Subject()
    """Whose body."""

    controller: Controller = "thesis"
    """`thesis`: foot paths by inverse kinematics, balance assumed; `balanced`: no external force."""

    gait: GaitParameters = GaitParameters()
    balanced: BalancedWalkParameters = BalancedWalkParameters()
    pushes: PushParameters = PushParameters()
    """Pushes against the body, with `controller: balanced`."""

    follow: FollowParameters = FollowParameters()
    start: StartParameters = StartParameters()
    inverse_kinematics: InverseKinematicsParameters = InverseKinematicsParameters()
    actuators: ActuatorParameters = ActuatorParameters()
    balance: BalanceParameters = BalanceParameters()
    simulation: SimulationParameters = SimulationParameters()
    recording: RecordingParameters = RecordingParameters()

    @property
    def commanded_speed(self) -> float:
        """Forward speed of the walk [m/s]; of a balanced one, the greatest that is asked for in either direction."""
        if self.controller == "thesis":
            return self.gait.ramp.speed
        return max((point.forward for point in self.balanced.command.points), key=abs, default=0.0)

    def __post_init__(self) -> None:
        """Check every number against its range, and the numbers that belong together.

        Raises:
            ParameterError: with the field, the value, the allowed range and a mend, in one line.
        """
        check(self)
        for name, angle in self.start.joint_angles.items():
            require_in_range(f"start.joint_angles.{name}", angle, "rad", -math.pi, math.pi)
        if self.follow.file and (self.balance.foot_force.enabled or self.balance.upper_body.enabled):
            raise ParameterError(
                "follow.file: a recording is followed joint by joint, which balance.foot_force and balance.upper_body "
                "would change; allowed: with balance.support or nothing; set their enabled: false"
            )
        if self.follow.file and self.controller == "balanced":
            raise ParameterError(
                "follow.file: a recording is not followed on the walker's own feet; allowed: with controller thesis, "
                "whose pelvis is supported; set controller: thesis"
            )
        if self.follow.kinematic and not self.follow.file:
            raise ParameterError(
                "follow.kinematic: true without a recording; allowed: with follow.file; name the recording (--follow)"
            )
        simulation = self.simulation
        if simulation.integrator == "cenic" and simulation.time_step != 0:
            raise ParameterError(
                f"simulation.time_step: {simulation.time_step:g} does not go with integrator cenic; allowed: 0; "
                "set time_step: 0, or integrator: discrete"
            )
        if simulation.integrator == "discrete" and simulation.time_step == 0:
            raise ParameterError(
                "simulation.time_step: 0 needs an integrator that keeps joint limits; allowed: above 0 to 0.01 s "
                "with integrator discrete; set time_step: 0.001, or integrator: cenic"
            )


def shipped_scenarios() -> dict[str, Path]:
    """Files of the scenarios that come with humanwalk, by name."""
    folder = Path(str(resources.files("humanwalk"))) / "models" / "scenarios"
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}


def load_scenario(name_or_path: str | Path, overrides: Mapping[str, str] | None = None) -> Scenario:
    """Load a shipped scenario by name, or any scenario by the path of its file.

    Args:
        name_or_path: "thesis", or a YAML file.
        overrides: values to replace by dotted field name, each written as in YAML, e.g.
            {"gait.path.step_height": "0.12"}.

    Raises:
        ParameterError: no such scenario, not a scenario, or a value that cannot be used; one line.
    """
    shipped = shipped_scenarios()
    path = shipped.get(str(name_or_path), Path(name_or_path))
    text = _read_text(path, f"scenario: {name_or_path}", f"{', '.join(shipped)}, or the path of a YAML file")
    return parse_scenario(text, overrides, name=path.name, folder=path.parent)


def load_as[T](kind: type[T], path: Path) -> T:
    """A YAML file as an instance of a dataclass of parameters, read as strictly as a scenario.

    Raises:
        ParameterError: it cannot be read, or a value cannot be used; one line.
    """
    text = _read_text(path, str(path), "a YAML file")
    try:
        parameters = _build(kind, _read_yaml(text, path.name), "")
        check(parameters)
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from None
    assert isinstance(parameters, kind)
    return parameters


def parse_scenario(
    text: str, overrides: Mapping[str, str] | None = None, name: str = "scenario", folder: Path = Path()
) -> Scenario:
    """Scenario from YAML text; see `load_scenario`. Files that the text names stand in `folder`, if not elsewhere."""
    data = _read_yaml(text, name)
    follow = data.get("follow")
    if isinstance(follow, dict):
        for key in ("file", "mapping"):
            if isinstance(follow.get(key), str) and follow[key]:
                follow[key] = str(folder / follow[key])
    for key, value in (overrides or {}).items():
        _override(data, key, _read_scalar(value, key))
    scenario = _build(Scenario, data, "")
    assert isinstance(scenario, Scenario)
    return scenario


def dump_scenario(scenario: Scenario) -> str:
    """The complete scenario as YAML, every field written out; `parse_scenario` reads it back to an equal one."""
    text: str = yaml_dump(dataclasses.asdict(scenario))
    return text


def _read_text(path: Path, name: str, allowed: str) -> str:
    try:
        # A pipe or a device may never end.
        if path.exists() and not (path.is_file() or path.is_dir()):
            raise ParameterError(f"{name}: is no file; allowed: {allowed}")
        if path.stat().st_size > LARGEST_FILE:
            raise ParameterError(f"{name}: too large; allowed: up to {LARGEST_FILE // 1000} kB; is it a scenario?")
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError, ValueError) as error:
        if isinstance(error, ParameterError):
            raise
        reason = error.strerror if isinstance(error, OSError) else "is not text"
        raise ParameterError(f"{name}: {reason}; allowed: {allowed}") from None


def _read_yaml(text: str, name: str) -> dict[str, Any]:
    try:
        _require_keys_once(yaml.compose(text, Loader=yaml.SafeLoader), name)
        data = yaml_load(data=text, private=True) if text.strip() else {}
    except ParameterError:
        raise
    except (yaml.YAMLError, ValueError, AttributeError, RecursionError) as error:
        # PyYAML lets an AttributeError out of a bad !!timestamp.
        mark = getattr(error, "problem_mark", None)
        where = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        problem = getattr(error, "problem", None) or "cannot be read"
        raise ParameterError(f"{name}: not YAML{where}: {problem}; mend that line") from None
    if data is None:
        return {}
    if not isinstance(data, dict):
        raise ParameterError(f"{name}: a scenario is a mapping of fields, like `duration: 15`")
    # Root keys that begin with an underscore hold anchors, as everywhere in Drake; a tag is no such key.
    return {key: value for key, value in data.items() if key == "_tag" or not str(key).startswith("_")}


def _require_keys_once(root: yaml.Node | None, name: str) -> None:
    """Raise ParameterError where a mapping has a key twice: YAML readers keep the last without a word."""
    waiting, seen = [root], set()
    while waiting:
        node = waiting.pop()
        # An anchor may stand in many places, and contain itself.
        if not isinstance(node, yaml.CollectionNode) or id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            waiting.extend(node.value)
            continue
        lines: dict[str, int] = {}
        for key, entry in node.value:
            waiting.extend((key, entry))
            if isinstance(key, yaml.ScalarNode):
                line = key.start_mark.line + 1
                if key.value in lines:
                    raise ParameterError(
                        f"{name}: {_shown(key.value)} comes twice, at lines {lines[key.value]} and {line}; allowed: "
                        "every field once in its group; remove one"
                    )
                lines[key.value] = line


def _read_scalar(value: str, key: str) -> Any:
    return _read_yaml(f"value: {value}", f"--set {key}")["value"]


def _override(data: dict[str, Any], key: str, value: Any) -> None:
    *parents, leaf = key.split(".")
    for parent in parents:
        child = data.setdefault(parent, {})
        if not isinstance(child, dict):
            raise ParameterError(f"{key}: {parent} holds no fields; name a field of the scenario")
        data = child
    data[leaf] = value


def _build(kind: Any, value: Any, path: str) -> Any:
    """`value` out of a YAML file as an instance of the annotated type `kind`.

    pydrake's own typed loader knows neither frozen dataclasses nor Literal, and its messages are no single lines.
    """
    origin = typing.get_origin(kind)
    if dataclasses.is_dataclass(kind):
        return _build_dataclass(kind, value, path)
    if origin is Literal:
        choices = typing.get_args(kind)
        if value not in choices:
            raise ParameterError(
                f"{path}: {_shown(value)} is unknown; allowed: {', '.join(choices)}"
                f"{_did_you_mean(_shown(value), choices)}"
            )
        return value
    if origin is tuple:
        item = typing.get_args(kind)[0]
        if not isinstance(value, list | tuple):
            raise ParameterError(f"{path}: {_shown(value)} is no list; allowed: entries that begin with a dash")
        return tuple(_build(item, entry, f"{path}.{place}") for place, entry in enumerate(value))
    if origin in (dict, Mapping):
        item = typing.get_args(kind)[1]
        if not isinstance(value, dict):
            raise ParameterError(f"{path}: {_shown(value)} is no mapping; allowed: name: value pairs")
        for key in value:
            if not (isinstance(key, str) and key.isprintable()):
                raise ParameterError(f"{path}: {_shown(key)} is no name; allowed: name: value pairs")
        return {key: _build(item, entry, f"{path}.{key}") for key, entry in value.items()}
    return _build_scalar(kind, value, path)


def _build_dataclass(kind: Any, value: Any, path: str) -> Any:
    if not isinstance(value, dict):
        raise ParameterError(
            f"{path}: {_shown(value)} is not a group of fields; allowed: "
            f"{', '.join(f.name for f in dataclasses.fields(kind))}"
        )
    hints = typing.get_type_hints(kind)
    names = [f.name for f in dataclasses.fields(kind)]
    arguments = {}
    for key, entry in value.items():
        shown = key if isinstance(key, str) and key.isprintable() else _shown(key)
        name = f"{path}.{shown}" if path else shown
        if key not in names:
            raise ParameterError(f"{name}: no such field; allowed: {', '.join(names)}{_did_you_mean(shown, names)}")
        arguments[key] = _build(hints[key], entry, name)
    try:
        return kind(**arguments)
    except ParameterError as error:
        raise ParameterError(f"{path}.{error}" if path else str(error)) from None


def _build_scalar(kind: Any, value: Any, path: str) -> Any:
    wanted = {float: "a number", int: "a whole number", bool: "true or false", str: "text"}[kind]
    if isinstance(value, int) and value.bit_length() > 64:
        raise ParameterError(f"{path}: {_shown(value)} is out of range; write a smaller number")
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if kind is float and isinstance(value, str):
        # YAML 1.1 reads 1e-3 as text: it wants 1.0e-3.
        try:
            return float(value)
        except ValueError:
            pass
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise ParameterError(f"{path}: {_shown(value)} is not {wanted}; write {wanted}")
    return value


def _shown(value: Any) -> str:
    try:
        # Aliases of aliases may stand for more than memory holds: no more is looked at than is shown.
        text = _BRIEF.repr(value)
    except ValueError:
        return "a number of too many digits"  # Python refuses to write it
    return text if len(text) <= 40 else text[:37] + "..."


def _did_you_mean(text: str, choices: typing.Sequence[str]) -> str:
    near = difflib.get_close_matches(text, choices, n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""
