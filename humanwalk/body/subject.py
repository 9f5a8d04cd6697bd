"""The subject: the person that walks, its impairments, devices and loads."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from humanwalk.body.anatomy import human
from humanwalk.body.build import person
from humanwalk.body.de_leva import Sex
from humanwalk.body.devices import DEVICES, Assistance, Device
from humanwalk.body.growth import ADULT_AGE, MIN_AGE
from humanwalk.body.impairments import IMPAIRMENTS, Impairment
from humanwalk.body.loads import LOADS, Load, loaded
from humanwalk.body.measured import completed, read_measurements
from humanwalk.body.regions import regions
from humanwalk.body.sdf import Look
from humanwalk.body.skeleton import MASS_RANGE_KG, REFERENCE_MASS, REFERENCE_STATURE, STATURE_RANGE_M, Skeleton
from humanwalk.body_units import BodyScale
from humanwalk.quantity import ParameterError, check, choice_list, file_path, printable, quantity, tag_of

BODY_MASS_INDEX = (10.0, 80.0)
"""Range of mass over the square of stature [kg/m2]: adults die below 10 to 12 and cannot walk above 80 (our choice)."""

STATURE_AT_AGE = ((MIN_AGE, 1.00, 1.35), (10.0, 1.10, 1.65), (14.0, 1.15, 1.95), (ADULT_AGE, 1.20, STATURE_RANGE_M[1]))
"""Age [years], least and greatest stature [m]: about four standard deviations around the means of the CDC's growth
charts (from memory)."""


@dataclass(frozen=True)
class Subject:
    """The person that walks: the thesis' body scaled, or a woman, man, girl or boy, or measured segments.

    With impairments, devices and loads.
    """

    mass: float = quantity(REFERENCE_MASS, "kg", *MASS_RANGE_KG)
    """Body mass without impairments, devices and loads (thesis 3.3.1: 70 kg)."""

    stature: float = quantity(REFERENCE_STATURE, "m", *STATURE_RANGE_M)
    """Standing height (thesis 3.3.1: 1.75 m)."""

    sex: Literal["male", "female", "unspecified"] = "male"
    """Proportions: male and female are those of de Leva (1996); unspecified is the thesis' body."""

    age: float = quantity(30.0, "years", MIN_AGE, 100.0)
    """Age; below 18 the proportions are those of a girl or boy, after Jensen (1989)."""

    measured: str = file_path()
    """A .csv or .yaml file with measured lengths, widths and masses of segments; the rest is scaled. Needs a sex."""

    loads: tuple[Load, ...] = choice_list(LOADS)
    """What the person carries."""

    impairments: tuple[Impairment, ...] = choice_list(IMPAIRMENTS)
    """Joints and lengths that are not healthy."""

    devices: tuple[Device, ...] = choice_list(DEVICES)
    """Prosthesis and exoskeletons."""

    look: Look = "person"
    """Look of the body: a clothed person, or rods between joints with their axes and the contact spheres."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a person that cannot exist."""
        check(self)
        index, (low, high) = self.mass / self.stature**2, BODY_MASS_INDEX
        if not low <= index <= high:
            square = self.stature**2
            raise ParameterError(
                f"mass: {self.mass:g} kg at {self.stature:g} m is a body mass index of {index:.3g} kg/m2; allowed: "
                f"{low:g} to {high:g}; give {low * square:.3g} to {high * square:.3g} kg"
            )
        ages, lows, highs = zip(*STATURE_AT_AGE, strict=True)
        shortest, tallest = (float(np.interp(self.age, ages, limits)) for limits in (lows, highs))
        if not shortest <= self.stature <= tallest:
            raise ParameterError(
                f"stature: {self.stature:g} m is impossible at an age of {self.age:g} years; allowed: {shortest:.3g} "
                f"to {tallest:.3g} m; change stature or age"
            )
        if self.sex == "unspecified" and (self.age < ADULT_AGE or self.measured):
            field = "age" if self.age < ADULT_AGE else "measured"
            raise ParameterError(
                f"sex: unspecified is the thesis' adult body and takes no {field}; allowed: female, male; set sex"
            )

    def __str__(self) -> str:
        """Mass, stature, sex, age of a child, and loads, in one line."""
        texts = [f"{self.mass:g} kg, {self.stature:g} m"]
        texts += [self.sex] if self.sex != "unspecified" else []
        texts += [f"{self.age:g} years"] if self.age < ADULT_AGE else []
        texts += [tag_of(IMPAIRMENTS, impairment).replace("_", " ") for impairment in self.impairments]
        texts += [tag_of(DEVICES, device).replace("_", " ") for device in self.devices]
        return ", ".join((*texts, *(f"{tag_of(LOADS, load)} {load.total:g} kg" for load in self.loads)))

    @property
    def body(self) -> Skeleton:
        """The healthy skeleton without devices and loads.

        Raises:
            ParameterError: the file with measured segments cannot be used.
        """
        return BODIES[self.sex](self)

    @property
    def skeleton(self) -> Skeleton:
        """The skeleton with all impairments, devices and loads.

        Raises:
            ParameterError: the body cannot have them.
        """
        return self._skeleton(self.impairments, self.devices, self.loads)

    @property
    def known_skeleton(self) -> Skeleton:
        """The skeleton with what the walker's own model includes."""
        return self._skeleton(
            [part for part in self.impairments if part.known],
            [part for part in self.devices if part.known],
            [load for load in self.loads if load.known],
        )

    @property
    def assistance(self) -> tuple[Assistance, ...]:
        """Torques of all devices."""
        return tuple(torque for device in self.devices for torque in device.assistance())

    def _skeleton(
        self, impairments: Iterable[Impairment], devices: Iterable[Device], loads: Sequence[Load]
    ) -> Skeleton:
        skeleton = self.body
        kinds: dict[str, type[Impairment] | type[Device]] = {**IMPAIRMENTS, **DEVICES}
        for part in (*impairments, *devices):
            try:
                skeleton = part.applied(skeleton)
            except ParameterError as error:
                raise ParameterError(f"subject.{tag_of(kinds, part)}.{error}") from None
        return loaded(skeleton, loads)

    @property
    def known_mass(self) -> float:
        """Mass of body and known loads [kg]."""
        return self.mass + math.fsum(load.total for load in self.loads if load.known)

    @property
    def scale(self) -> BodyScale:
        """Factors from the reference body to this one with known loads; a leg is as long as its hip is high."""
        return BodyScale(self.body.hip_height / human().hip_height, self.known_mass / REFERENCE_MASS)


def _thesis_body(subject: Subject) -> Skeleton:
    if (subject.mass, subject.stature) == (REFERENCE_MASS, REFERENCE_STATURE):
        return human()
    return human().scaled(subject.mass, subject.stature)


def _table_body(sex: Sex) -> Callable[[Subject], Skeleton]:
    def body(subject: Subject) -> Skeleton:
        segments = regions(sex, subject.age, subject.mass, subject.stature)
        if not subject.measured:
            return person(sex, segments)
        try:
            measured = read_measurements(Path(subject.measured))
        except ParameterError as error:
            raise ParameterError(f"subject.measured: {error}") from None
        try:
            return person(sex, completed(segments, measured))
        except ParameterError as error:
            raise ParameterError(f"subject.measured: {printable(subject.measured)}: {error}") from None

    return body


BODIES: dict[str, Callable[[Subject], Skeleton]] = {
    "unspecified": _thesis_body,
    "female": _table_body("female"),
    "male": _table_body("male"),
}
"""Body of a subject, by its sex."""
