"""Measured segments: lengths, widths and masses out of a file, and the rest scaled to fit the person."""

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from humanwalk.body.regions import ANKLE_HEIGHT, TRUNK, WIDTHS, Region, Regions, limb_width, region_names
from humanwalk.files import read_text
from humanwalk.parameter_file import MAX_FILE_SIZE, build, load_as
from humanwalk.quantity import ParameterError, did_you_mean, number_of, printable, quantity
from humanwalk.sides import SIDES

COLUMNS = {"length_m": "length", "width_m": "width", "mass_kg": "mass"}
"""Columns of a CSV file beside `segment`, and their fields."""

TOLERANCE = 0.02
"""Largest relative difference of measured segments from stature or body mass; it is divided among them."""

REST_RANGE = (0.6, 1.6)
"""What is left for the segments that are not measured, relative to the table's: beyond, a figure is wrong."""


@dataclass(frozen=True)
class Measurement:
    """What was measured of a segment; 0 where nothing was."""

    length: float = quantity(0.0, "m", 0.0, 1.0)
    """Between the joint centers; head: from C7 to the vertex; hand and foot: to the tip."""

    width: float = quantity(0.0, "m", 0.0, 1.0)
    """Mean breadth; upper trunk: distance of the shoulder joints; lower trunk: distance of the hip joints."""

    mass: float = quantity(0.0, "kg", 0.0, 100.0)


@dataclass(frozen=True)
class Measurements:
    """File with measured segments."""

    segments: Mapping[str, Measurement] = field(default_factory=dict)
    """By name: head, upper_trunk, middle_trunk, lower_trunk, upper_arm, forearm, hand, thigh, shank, foot; those of
    limbs stand for both sides, or begin with right_ or left_."""


def read_measurements(path: Path) -> Mapping[str, Measurement]:
    """Read measured segments from a YAML or CSV file, one for each side of the body.

    Raises:
        ParameterError: the file cannot be read, or a value in it cannot be used.
    """
    readers = {".yaml": _read_yaml, ".yml": _read_yaml, ".csv": _read_csv}
    read = readers.get(path.suffix.lower())
    if read is None:
        raise ParameterError(f"{printable(path)}: unknown format; allowed: {', '.join(readers)}; convert the file")
    given = read(path).segments
    known = [*region_names()]
    names = tuple(dict.fromkeys(name for pair in known for name in pair))
    if not given:
        raise ParameterError(
            f"{printable(path)}: no segment; allowed: one or more of {', '.join(names)}; add a segment"
        )
    for name in given:
        if name not in names:
            raise ParameterError(
                f"{printable(path)}: {printable(name)} is no segment; allowed: {', '.join(names)}"
                f"{did_you_mean(name, names)}"
            )
    other = {"right": "left", "left": "right"}
    found = {}
    for name, limb in known:
        side, _, rest = name.partition("_")
        for source in (name, limb, f"{other[side]}_{rest}" if side in other else name):
            if source in given:
                found[name] = given[source]
                break
    return found


def completed(expected: Regions, measured: Mapping[str, Measurement]) -> Regions:
    """Return the segments of a person, as measured where they are, else scaled to reach stature and body mass.

    A length that was not measured is the table's times one factor for trunk, head and legs, which makes the stature. A
    mass that was not measured is the table's, in proportion to length and, but for the trunk, square of width where
    these were measured, times one factor that makes the body mass.

    Args:
        expected: The person's segments after the table; they have its stature and mass.
        measured: By name, as `read_measurements` returns them.

    Raises:
        ParameterError: the person cannot have these segments.
    """
    lengths = _lengths(expected, measured)
    masses = _masses(expected, measured, lengths)
    return {
        name: _region(region, measured.get(name, Measurement()), lengths[name], masses[name], name)
        for name, region in expected.items()
    }


def _region(region: Region, measured: Measurement, length: float, mass: float, name: str) -> Region:
    longer, (kx, ky, kz) = length / region.length, region.gyration
    usual = region.width if name.partition("_")[2] in WIDTHS or name in WIDTHS else limb_width(mass, length)
    # The radius about the long axis is proportional to the width: the foot's is x, the others' z.
    wider = measured.width / region.width if measured.width else longer
    foot, trunk = name.endswith("foot"), name in ("head", *TRUNK)
    about_x, about_z = (wider, longer) if foot else (longer, longer if trunk else wider)
    return replace(
        region,
        length=length,
        width=measured.width or usual,
        mass=mass,
        com=region.com * longer,
        gyration=(kx * about_x, ky * longer, kz * about_z),
    )


def _lengths(expected: Regions, measured: Mapping[str, Measurement]) -> dict[str, float]:
    """Lengths of all segments; those of trunk, head and the longer leg add up to the stature but for the ankle."""
    lengths = {name: region.length for name, region in expected.items()}
    given = {name: found.length for name, found in measured.items() if found.length}
    legs = [(f"{side.lower()}_thigh", f"{side.lower()}_shank") for side in SIDES]
    chains = [("head", *TRUNK, *leg) for leg in legs]
    height = math.fsum(lengths[name] for name in chains[0])
    factors = []
    for chain in chains:
        free = math.fsum(lengths[name] for name in chain if name not in given)
        taken = math.fsum(given.get(name, 0.0) for name in chain)
        if free:
            factors.append((height - taken) / free)
        elif abs(taken / height - 1.0) > TOLERANCE and taken == max(_sum(given, c) for c in chains):
            stature = taken / (1.0 - ANKLE_HEIGHT)
            raise ParameterError(
                f"lengths of trunk, head and leg make a stature of {stature:.3g} m; allowed: within "
                f"{100 * TOLERANCE:g} % of the subject's, {height / (1.0 - ANKLE_HEIGHT):.3g} m; correct one of them"
            )
    factor = min(factors, default=1.0)
    _require_plausible("length", factor)
    in_chain = {name for chain in chains for name in chain}
    lengths |= {name: factor * lengths[name] for name in in_chain} | given
    exact = height / max(_sum(lengths, chain) for chain in chains)
    return lengths | {name: exact * lengths[name] for name in in_chain}


def _masses(expected: Regions, measured: Mapping[str, Measurement], lengths: Mapping[str, float]) -> dict[str, float]:
    """Masses of all segments [kg]; they add up to the body mass."""
    body_mass = math.fsum(region.mass for region in expected.values())
    given = {name: found.mass for name, found in measured.items() if found.mass}
    usual = {}
    for name, region in expected.items():
        # Widths of the trunk are distances of joints, not girths.
        width = measured[name].width if name in measured and name not in TRUNK else 0.0
        usual[name] = region.mass * lengths[name] / region.length * ((width or region.width) / region.width) ** 2
    free = math.fsum(mass for name, mass in usual.items() if name not in given)
    taken = math.fsum(given.values())
    if free:
        factor = (body_mass - taken) / free
        _require_plausible("mass", factor)
        return {name: given.get(name, factor * mass) for name, mass in usual.items()}
    if abs(taken / body_mass - 1.0) > TOLERANCE:
        raise ParameterError(
            f"masses add up to {taken:.4g} kg; allowed: within {100 * TOLERANCE:g} % of the subject's, {body_mass:.4g} "
            "kg; correct one of them"
        )
    return {name: mass * body_mass / taken for name, mass in given.items()}


def _require_plausible(quantity_name: str, factor: float) -> None:
    low, high = REST_RANGE
    if not low <= factor <= high:
        raise ParameterError(
            f"{quantity_name}: the measured segments leave {100 * factor:.0f} % of the usual {quantity_name} for the "
            f"others; allowed: {100 * low:g} to {100 * high:g} %; correct a figure, or the subject's stature and mass"
        )


def _sum(lengths: Mapping[str, float], chain: tuple[str, ...]) -> float:
    return math.fsum(lengths.get(name, 0.0) for name in chain)


def _read_yaml(path: Path) -> Measurements:
    return load_as(Measurements, path)


def _read_csv(path: Path) -> Measurements:
    name = printable(path)
    text = read_text(path, MAX_FILE_SIZE)
    try:
        rows = list(csv.reader(text.splitlines(), skipinitialspace=True))
    except csv.Error as error:
        raise ParameterError(f"{name}: {error}; allowed: a table with commas; save it as that") from None
    header = [cell.strip() for cell in rows[0]] if rows else []
    if "segment" not in header or set(header) - {"segment", *COLUMNS} or len(set(header)) < len(header):
        raise ParameterError(
            f"{name}: columns {printable(', '.join(header))}; allowed: segment, {', '.join(COLUMNS)}, each once; write "
            "them in the first row"
        )
    segments: dict[str, dict[str, float]] = {}
    for number, row in enumerate(rows[1:], 2):
        cells = dict(zip(header, map(str.strip, row), strict=False))
        if not any(cells.values()):
            continue
        segment = cells.pop("segment")
        if len(row) != len(header) or segment in segments:
            problem = "is there twice" if segment in segments else f"has {len(row)} cells"
            raise ParameterError(
                f"{name}, row {number}: {printable(segment)} {problem}; allowed: {len(header)} cells, each segment "
                "once; correct it"
            )
        segments[segment] = {}
        for column, cell in cells.items():
            if cell:
                segments[segment][COLUMNS[column]] = _number(cell, f"{name}, row {number}: {column}")
    try:
        return build(Measurements, {"segments": segments})
    except ParameterError as error:
        raise ParameterError(f"{name}: {error}") from None


def _number(cell: str, place: str) -> float:
    try:
        return number_of(cell)
    except ValueError:
        raise ParameterError(
            f"{place}: {printable(cell, 40)} is not a number; allowed: a number or an empty cell; correct it"
        ) from None
