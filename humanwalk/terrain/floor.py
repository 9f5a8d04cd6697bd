"""Level ground: a half-space to stand on, and a floor with a line at every metre to look at."""

import numpy as np
from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, Box, HalfSpace, ProximityProperties
from pydrake.math import RigidTransform
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant

from humanwalk.body.contact import FRICTION
from humanwalk.scenario import Contact

LENGTH = 60
WIDTH = 10
BEHIND = 6
"""Size of the floor that is seen [m], and how much of its length lies behind the start; the half-space has no end."""

FLOOR_COLOR = np.array([0.86, 0.87, 0.86, 1.0])
LINE_COLOR = np.array([0.60, 0.62, 0.63, 1.0])
MARK_COLOR = np.array([0.36, 0.40, 0.43, 1.0])

LINE_WIDTH = 0.012
MARK_WIDTH = 0.03
"""Of the line at every metre, and at every fifth across the walk [m]."""


def add_level_ground(plant: MultibodyPlant, contact: Contact) -> None:
    """Add a rigid half-space z < 0 with the thesis' friction, and a floor with a grid of metres to look at."""
    properties = ProximityProperties()
    AddContactMaterial(friction=CoulombFriction(FRICTION, FRICTION), properties=properties)
    if contact == "hydroelastic":
        AddRigidHydroelasticProperties(properties)
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", properties)
    _add_floor(plant)


def _add_floor(plant: MultibodyPlant) -> None:
    def add(name: str, x: float, y: float, length: float, width: float, top: float, color: np.ndarray) -> None:
        thickness = 0.02
        X_WG = RigidTransform(np.array([x, y, top - 0.5 * thickness]))
        plant.RegisterVisualGeometry(plant.world_body(), X_WG, Box(length, width, thickness), name, color)

    middle = 0.5 * LENGTH - BEHIND
    # The floor and the lines that cross each other have tops of their own: of two at one height neither is seen.
    add("floor", middle, 0.0, LENGTH, WIDTH, -0.002, FLOOR_COLOR)
    for y in range(-WIDTH // 2 + 1, WIDTH // 2):
        add(f"along_{y}", middle, float(y), LENGTH, LINE_WIDTH, -0.001, LINE_COLOR)
    for x in range(1 - BEHIND, LENGTH - BEHIND):
        mark = x % 5 == 0
        add(
            f"metre_{x}",
            float(x),
            0.0,
            MARK_WIDTH if mark else LINE_WIDTH,
            WIDTH,
            0.0,
            MARK_COLOR if mark else LINE_COLOR,
        )
