"""Segments of the mean young woman and man, after de Leva.

P. de Leva (1996), Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J Biomech 29:1223-1230, Table 4,
from two independent public transcriptions that agree. Lengths are between joint centers where the table has them. The
table has no breadths.
"""

from dataclasses import dataclass
from typing import Literal

from humanwalk.body.shapes import Vector3

Sex = Literal["female", "male"]


@dataclass(frozen=True)
class TableRow:
    """A segment as shares of the body.

    Attributes:
        length: Length in the mean subject [m].
        mass: Share of the body mass.
        com: Distance of the center of mass from the upper end (foot: from the heel), share of the length.
        gyration: Radii of gyration about x forward, y left, z up in standing, shares of the length. The table's
            sagittal, transverse and longitudinal axes are x, y and z; a hanging hand turns its palm to the thigh, so
            that its sagittal axis is y, and the longitudinal axis of a foot is x.
    """

    length: float
    mass: float
    com: float
    gyration: Vector3


@dataclass(frozen=True)
class Table:
    """The mean subject of a sex.

    Attributes:
        mass: Body mass [kg].
        stature: [m].
        rows: By the name of the region; limbs once, for each side.
    """

    mass: float
    stature: float
    rows: dict[str, TableRow]


DE_LEVA: dict[Sex, Table] = {
    "female": Table(
        61.9,
        1.735,
        {
            "head": TableRow(0.2437, 0.0668, 0.4841, (0.271, 0.295, 0.261)),
            "upper_trunk": TableRow(0.2280, 0.1545, 0.5050, (0.466, 0.314, 0.449)),
            "middle_trunk": TableRow(0.2053, 0.1465, 0.4512, (0.433, 0.354, 0.415)),
            "lower_trunk": TableRow(0.1815, 0.1247, 0.4920, (0.433, 0.402, 0.444)),
            "upper_arm": TableRow(0.2751, 0.0255, 0.5754, (0.278, 0.260, 0.148)),
            "forearm": TableRow(0.2643, 0.0138, 0.4559, (0.261, 0.257, 0.094)),
            "hand": TableRow(0.1701, 0.0056, 0.3427, (0.208, 0.244, 0.154)),
            "thigh": TableRow(0.3685, 0.1478, 0.3612, (0.369, 0.364, 0.162)),
            "shank": TableRow(0.4386, 0.0481, 0.4352, (0.267, 0.263, 0.092)),
            "foot": TableRow(0.2283, 0.0129, 0.4014, (0.139, 0.299, 0.279)),
        },
    ),
    "male": Table(
        73.0,
        1.741,
        {
            "head": TableRow(0.2429, 0.0694, 0.5002, (0.303, 0.315, 0.261)),
            "upper_trunk": TableRow(0.2421, 0.1596, 0.5066, (0.505, 0.320, 0.465)),
            "middle_trunk": TableRow(0.2155, 0.1633, 0.4502, (0.482, 0.383, 0.468)),
            "lower_trunk": TableRow(0.1457, 0.1117, 0.6115, (0.615, 0.551, 0.587)),
            "upper_arm": TableRow(0.2817, 0.0271, 0.5772, (0.285, 0.269, 0.158)),
            "forearm": TableRow(0.2689, 0.0162, 0.4574, (0.276, 0.265, 0.121)),
            "hand": TableRow(0.1879, 0.0061, 0.3624, (0.235, 0.288, 0.184)),
            "thigh": TableRow(0.4222, 0.1416, 0.4095, (0.329, 0.329, 0.149)),
            "shank": TableRow(0.4403, 0.0433, 0.4395, (0.251, 0.246, 0.102)),
            "foot": TableRow(0.2581, 0.0137, 0.4415, (0.124, 0.257, 0.245)),
        },
    ),
}
