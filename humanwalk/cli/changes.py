"""The options that change a scenario, the same for every command that takes one: --set and its shorthands."""

import dataclasses
import functools
import inspect
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from humanwalk.quantity import ParameterError, is_within

if TYPE_CHECKING:
    from humanwalk.body.subject import Subject

# The help lists the shorthands without importing their grammar, and Drake with it; a test compares both.


PANEL = "Changes of the scenario"


def _option(*names: str, help: str, metavar: str | None = None) -> Any:
    return typer.Option(*names, help=help, metavar=metavar, rich_help_panel=PANEL)


SetOption = Annotated[
    list[str],
    _option(
        "--set",
        metavar="FIELD=VALUE",
        help="Replace a field of the scenario; can be given several times.",
    ),
]


@dataclass(frozen=True)
class Changes:
    """Changes of a scenario, as written on the command line; every field is an option."""

    set_: SetOption = dataclasses.field(default_factory=list)
    speed: Annotated[
        float | None,
        _option(help="Greatest forward speed that is commanded [m/s]; other forward speeds in proportion."),
    ] = None
    push: Annotated[
        list[str],
        _option(
            metavar="PUSH",
            help='Push, instead of the scenario\'s, like "60 N s at 8 s from behind"; can be given several times. '
            "Grammar: IMPULSE N s at TIME s from SIDE [for DURATION s] [on BODY]; SIDE is front, behind, left, right, "
            "or an angle like 45 deg: 0 is the front, 90 the left (of a walker that faces x).",
        ),
    ] = dataclasses.field(default_factory=list)
    mass: Annotated[float | None, _option(help="Body mass [kg].")] = None
    stature: Annotated[float | None, _option(help="Standing height [m].")] = None
    sex: Annotated[
        str | None, _option(help="female or male: proportions after de Leva (1996); unspecified: the thesis' body.")
    ] = None
    age: Annotated[
        float | None, _option(help="Age [years], from 6; below 18 proportions of children. Needs a sex.")
    ] = None
    load: Annotated[
        list[str],
        _option(
            metavar="LOAD",
            help='Carry, instead of the scenario\'s loads, like "backpack 10 kg"; can be given several times. '
            "Grammar: LOAD MASS kg [in the right hand | in the left hand] [unknown]; LOAD is backpack, vest, ankle "
            "weights (mass of each) or suitcase; unknown: the walker's model of its body lacks it.",
        ),
    ] = dataclasses.field(default_factory=list)
    impairment: Annotated[
        list[str],
        _option(
            metavar="IMPAIRMENT",
            help='Impairment, instead of the scenario\'s, like "stiff knee left 10 deg" or "short leg 3 cm"; can be '
            "given several times. Grammar: IMPAIRMENT [right | left | both] [[FIELD] VALUE [UNIT], ...] [unknown]; "
            "IMPAIRMENT is stiff knee, weak plantarflexors, hip contracture, short leg or joint.",
        ),
    ] = dataclasses.field(default_factory=list)
    device: Annotated[
        list[str],
        _option(
            metavar="DEVICE",
            help='Device, instead of the scenario\'s, like "ankle prosthesis left" or "hip exoskeleton 15 N m"; can be '
            "given several times. Grammar: DEVICE [right | left | both] [[FIELD] VALUE [UNIT], ...] [unknown]; DEVICE "
            "is ankle prosthesis, ankle exoskeleton or hip exoskeleton.",
        ),
    ] = dataclasses.field(default_factory=list)
    terrain: Annotated[
        str | None,
        _option(
            metavar="TERRAIN",
            help='Ground, like "plane slope 3 deg, friction coefficient 0.5", or pieces of a course, like '
            '"stairs down 17 cm, number 8 then obstacle 20 cm". Grammar: '
            "[TERRAIN] [FIELD VALUE [UNIT]], ..., or PIECE [up | down] [[FIELD] VALUE [UNIT], ...] [then PIECE ...]",
        ),
    ] = None

    def overrides(self, scenario: str, base: Mapping[str, str] | None = None) -> dict[str, str]:
        """Overrides by field name, for `load_scenario`: `base`, then those of --set, then the shorthands.

        Args:
            scenario: Name or path; the field that commands the speed depends on its controller.
            base: Other overrides by field name.

        Raises:
            ParameterError: a text that cannot be read, a field of --set that a shorthand replaces, or a scenario whose
                speed cannot be set.
        """
        from humanwalk.cli.shorthands import push_overrides, terrain_overrides

        given, shorthands = overrides_of(self.set_), self._of_subject()
        if self.terrain is not None:
            shorthands |= terrain_overrides(self.terrain)
        if self.push:
            shorthands |= push_overrides(self.push)
        require_kept(given, shorthands)
        overrides = {**(base or {}), **given, **shorthands}
        if self.speed is not None:
            overrides |= speed_overrides(self.speed, scenario, overrides)
        if self.shorthands and "description" not in overrides:
            overrides["description"] = described(scenario, self.shorthands)
        return overrides

    def subject(self, scenario: str) -> "Subject":
        """The subject of a scenario with these changes.

        Args:
            scenario: Name or path.

        Raises:
            ParameterError: a subject that is not possible.
        """
        from humanwalk.scenario import load_scenario

        given = {name: value for name, value in overrides_of(self.set_).items() if name.partition(".")[0] == "subject"}
        return load_scenario(scenario, {**given, **self._of_subject()}).subject

    def _of_subject(self) -> dict[str, str]:
        """Overrides of the shorthands of the subject."""
        from humanwalk.cli.shorthands import device_overrides, impairment_overrides, load_overrides

        overrides = {}
        for name in ("mass", "stature", "sex", "age"):
            if getattr(self, name) is not None:
                overrides[f"subject.{name}"] = repr(getattr(self, name))
        if self.load:
            overrides |= load_overrides(self.load)
        if self.impairment:
            overrides |= impairment_overrides(self.impairment)
        if self.device:
            overrides |= device_overrides(self.device)
        return overrides

    @property
    def shorthands(self) -> list[str]:
        """The shorthands that are given, for people."""
        numbers = {
            "speed": (self.speed, "m/s"),
            "mass": (self.mass, "kg"),
            "stature": (self.stature, "m"),
            "age": (self.age, "years"),
        }
        texts = [f"{name} {value:g} {unit}" for name, (value, unit) in numbers.items() if value is not None]
        texts += [text for text in (self.sex, self.terrain) if text is not None]
        texts += [*self.load, *self.impairment, *self.device]
        return texts + [f"push {push}" for push in self.push]


def overrides_of(pairs: list[str]) -> dict[str, str]:
    """Fields and values of --set.

    Raises:
        ParameterError: A pair is not FIELD=VALUE, or replaces an earlier one.
    """
    overrides: dict[str, str] = {}
    for pair in pairs:
        key, equals, value = pair.partition("=")
        if not equals or not key:
            raise ParameterError(f"--set {pair}: not FIELD=VALUE; allowed: like controller.thesis.gait.ramp.speed=1.2")
        for earlier in overrides:
            if is_within(earlier, key):
                raise ParameterError(
                    f"--set {key}: replaces the earlier --set {earlier}; allowed: each field once, or a group before a "
                    "field in it; change the order, or remove one"
                )
        overrides[key] = value
    return overrides


def option_overrides(pairs: list[str], options: Mapping[str, str | float | None]) -> dict[str, str]:
    """Overrides of options that each set one field.

    Args:
        pairs: Those of --set.
        options: Values by field name; None for an option that is not given.

    Raises:
        ParameterError: A field of --set that an option replaces.
    """
    overrides = {field: str(value) for field, value in options.items() if value is not None}
    require_kept(overrides_of(pairs), overrides)
    return overrides


def require_kept(given: Iterable[str], shorthands: Iterable[str]) -> None:
    """Raise ParameterError for a field of --set that is, or is in, a field that a shorthand replaces."""
    for field, replaced in product(given, shorthands):
        if is_within(field, replaced):
            raise ParameterError(
                f"--set {field}: another option replaces {replaced}; allowed: one of the two; leave one out"
            )


def described(scenario: str, shorthands: list[str]) -> str:
    """Description of a scenario with shorthands, as YAML: its own could contradict them."""
    from humanwalk.scenario import load_scenario

    # JSON is YAML, and quotes any character.
    return json.dumps(f"{load_scenario(scenario).description}; changed: {', '.join(shorthands)}")


def speed_overrides(speed: float, scenario: str, overrides: dict[str, str]) -> dict[str, str]:
    """Overrides that set the commanded forward speed [m/s] of a scenario with overrides.

    Raises:
        ParameterError: its controller takes no speed.
    """
    from humanwalk.choices import CONTROLLERS
    from humanwalk.quantity import tag_of
    from humanwalk.scenario import load_scenario

    controller = load_scenario(scenario, overrides).controller
    tag = tag_of(CONTROLLERS, controller)
    return {
        f"controller.{tag}.{field}": json.dumps(value) for field, value in controller.fields_for_speed(speed).items()
    }


def takes_changes(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command an option for every field of its parameter `changes`, a `Changes`."""
    hints = get_type_hints(Changes, include_extras=True)
    keyword = inspect.Parameter.KEYWORD_ONLY
    options = [
        inspect.Parameter(field.name, keyword, default=_default(field), annotation=hints[field.name])
        for field in dataclasses.fields(Changes)
    ]

    @functools.wraps(command)
    def with_options(**arguments: Any) -> None:
        changes = Changes(**{option.name: arguments.pop(option.name) for option in options})
        command(**arguments, changes=changes)

    parameters: list[inspect.Parameter] = []
    for parameter in inspect.signature(command).parameters.values():
        if parameter.name == "changes":
            parameters.extend(options)
        else:
            parameters.append(parameter.replace(kind=keyword))
    vars(with_options)["__signature__"] = inspect.Signature(parameters)
    return with_options


def _default(field: dataclasses.Field[Any]) -> Any:
    return field.default if field.default_factory is dataclasses.MISSING else field.default_factory()
