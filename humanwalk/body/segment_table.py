"""A body's segments as gait laboratories define them, beside those of de Leva's tables."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from humanwalk.body.build import HEEL, REFERENCE_LENGTHS, REGION_BODIES, mass_properties
from humanwalk.body.de_leva import Sex
from humanwalk.body.regions import TRUNK, Region, Regions, regions
from humanwalk.body.skeleton import Skeleton
from humanwalk.body.subject import Subject

OUTER = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shank", "shank": "foot"}
"""Region that begins where another one ends, on the same side."""


@dataclass(frozen=True)
class SegmentRow:
    """A segment of a body and of the tables.

    Attributes:
        name: Name of the region.
        own: Its measures.
        reference: Those of a person of the same sex, age, mass and stature after the tables.
    """

    name: str
    own: Region
    reference: Region

    @property
    def ratios(self) -> tuple[float, float, float, float]:
        """Mass, and moments of inertia about x, y and z, over those of the reference."""
        mass = self.own.mass / self.reference.mass
        own, reference = np.square(self.own.gyration), np.square(self.reference.gyration)
        x, y, z = (mass * own / reference).tolist()
        return (mass, x, y, z)


def segment_rows(subject: Subject) -> Iterator[SegmentRow]:
    """Yield every segment of a subject's body without loads, beside the tables; the thesis' body beside men."""
    sex: Sex = "female" if subject.sex == "female" else "male"
    reference = regions(sex, subject.age, subject.mass, subject.stature)
    for name, own in regions_of(subject.body, reference).items():
        yield SegmentRow(name, own, reference[name])


def regions_of(body: Skeleton, like: Regions) -> Regions:
    """Return the segments of a skeleton, in neutral standing.

    Args:
        body: The skeleton.
        like: Segments with the ratios of the lengths of the trunk's parts, and with the widths.
    """
    found: dict[str, Region] = {}
    neck = float(body.origins["Cervical_5_7"][2])
    trunk = (neck - body.hip_height) / sum(like[name].length for name in TRUNK)
    top = {"head": body.stature}
    for name in TRUNK:
        top[name] = neck
        neck -= trunk * like[name].length
    for name, bodies in REGION_BODIES.items():
        mass, center, moments = mass_properties(body, bodies)
        kx, ky, kz = np.sqrt(moments / mass).tolist()
        first = body.origins[next(iter(bodies))]
        length = _length(body, name, like, trunk)
        if name.endswith("foot"):
            com = float(center[0] - first[0]) + HEEL * length
        else:
            com = float(top.get(name, first[2]) - center[2])
        found[name] = replace(like[name], length=length, mass=mass, com=com, gyration=(kx, ky, kz))
    return {name: found[name] for name in like}


def _length(body: Skeleton, name: str, like: Regions, trunk: float) -> float:
    """Length of a region of a skeleton [m]; `trunk` is the scale of the trunk's parts."""
    first = body.origins[next(iter(REGION_BODIES[name]))]
    side, _, limb = name.partition("_")
    if name == "head":
        return body.stature - float(first[2])
    if name in TRUNK:
        return trunk * like[name].length
    if limb in OUTER:
        return float(first[2] - body.origins[next(iter(REGION_BODIES[f"{side}_{OUTER[limb]}"]))][2])
    along, _, up = body.size(list(REGION_BODIES[name])[-1])
    return REFERENCE_LENGTHS[limb] * (along if limb == "foot" else up)
