"""Signals inside a replay page: a fixed list of numbers per sample, so that nothing of a page has to be trusted."""

import base64
import binascii

import numpy as np
import pyarrow as pa

from humanwalk.body import SIDES
from humanwalk.body.contact import SOLE_PARTS
from humanwalk.body.limbs import LEGS
from humanwalk.body.subject import Subject
from humanwalk.measures.curves import ANGLES, JOINTS
from humanwalk.measures.events import CONTACT_ON_N
from humanwalk.measures.orientation import sole_rotation
from humanwalk.measures.path import fore_aft_force, path_directions
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario

CHANNELS = (
    "time",
    *(f"{side} {name}" for side in SIDES for name in ("vertical", "fore-aft", "cop x", "cop y", *JOINTS)),
)
"""Numbers of a sample: time [s]; for each foot the force [N], the center of pressure [foot lengths], and angles [deg].

The center of pressure is measured from the heel in the direction of the foot, and to the left of its middle. Numbers
that do not exist, such as the center of pressure of an unloaded foot, are not a number.
"""

HEEL, TOE = SOLE_PARTS[0].x[0], SOLE_PARTS[-1].x[1]
"""Ends of the sole of the reference human, from the ankle [m]."""

SOLE_OUTLINE = [
    [round(value / (TOE - HEEL), 3) for value in (part.x[0] - HEEL, part.x[1] - HEEL, part.width)]
    for part in SOLE_PARTS
]
"""Rear end, front end and width of the parts of a sole [foot lengths]."""

MAX_MAGNITUDE = 1e9


def encode_samples(signals: pa.Table, scenario: Scenario) -> str:
    """The channels of a run as text: base64 of 32-bit floats, sample after sample."""
    time, subject = signals[TIME].to_numpy(), scenario.subject
    facing = path_directions(signals, scenario.controller.command).facing
    samples = np.full((time.size, len(CHANNELS)), np.nan)
    column = {name: samples[:, index] for index, name in enumerate(CHANNELS)}
    column["time"][:] = time
    for side in SIDES:
        for joint in JOINTS:
            column[f"{side} {joint}"][:] = ANGLES[joint].of(signals, side, subject.mass, facing)
    if f"{SIDES[0].lower()}_foot.force_z_N" in signals.column_names:
        cop = _centers_of_pressure(signals, subject)
        for place, side in enumerate(SIDES):
            vertical = signals[f"{side.lower()}_foot.force_z_N"].to_numpy()
            column[f"{side} fore-aft"][:] = fore_aft_force(signals, side, facing)
            column[f"{side} vertical"][:] = vertical
            loaded = vertical >= CONTACT_ON_N
            column[f"{side} cop x"][loaded] = cop[loaded, place, 0]
            column[f"{side} cop y"][loaded] = cop[loaded, place, 1]
    # A diverging run may have signals that are within the limit in SI units only.
    samples = np.clip(samples, -MAX_MAGNITUDE, MAX_MAGNITUDE)
    return base64.b64encode(samples.astype("<f4").tobytes()).decode()


def require_samples(text: str) -> None:
    """Raise ParameterError unless the text encodes samples: times that increase, and numbers that are not too large."""
    try:
        numbers = np.frombuffer(base64.b64decode(text, validate=True), "<f4")
        samples = numbers.reshape(-1, len(CHANNELS))
    except (binascii.Error, ValueError):
        raise ParameterError("its signals are not whole samples") from None
    with np.errstate(invalid="ignore"):
        bounded = np.isnan(samples) | (np.abs(samples) <= MAX_MAGNITUDE)
        increasing = np.diff(samples[:, 0]) > 0.0
    if not bounded.all() or not increasing.all() or not np.isfinite(samples[:, 0]).all():
        raise ParameterError("its signals are not finite, or not in the order of time")


def _centers_of_pressure(signals: pa.Table, subject: Subject) -> Array:
    """Centers of pressure in the frames of the soles [foot lengths], shape (rows, 2 feet, 2)."""
    skeleton = subject.skeleton
    length = np.array([skeleton.size(LEGS[side].hindfoot)[0] for side in SIDES])[:, None]
    cop = np.empty((signals.num_rows, len(SIDES), 2))
    for place, side in enumerate(SIDES):
        points, sole = (
            matrix(signals, [f"{side.lower()}_{name}{axis}_m" for axis in "xyz"]) for name in ("foot.cop_", "sole.")
        )
        cop[:, place] = sole_rotation(signals, side).inv().apply(points - sole)[:, :2]
    return np.asarray((cop / length - np.array((HEEL, 0.0))) / (TOE - HEEL))
