"""A load on the chest that is set while a diagram runs, beside those of the model file."""

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import RotationalInertia, SpatialInertia
from pydrake.systems.framework import Context

from humanwalk.body.limbs import CHEST
from humanwalk.numerics import Array

NO_LOAD = np.zeros(4)
"""Mass [kg] and position in the frame of the chest [m] of no load."""


class CarriedLoad:
    """A point mass on the chest in one context of a plant.

    Args:
        plant: Finalized model of the body.
        context: Of the plant, in which the load is set.
    """

    def __init__(self, plant: MultibodyPlant, context: Context) -> None:
        self._plant, self._context, self._load = plant, context, NO_LOAD
        chest = plant.GetBodyByName(CHEST)
        self._chest, self._unloaded = chest.index(), chest.default_spatial_inertia()

    @property
    def mass(self) -> float:
        """Mass of the load [kg]."""
        return float(self._load[0])

    def set(self, load: Array) -> None:
        """Carry a load: its mass [kg], and its position in the frame of the chest [m], shape (4,)."""
        if np.array_equal(load, self._load):
            return
        self._load = load.copy()
        inertia = self._unloaded
        if self.mass > 0.0:
            inertia = SpatialInertia.MakeFromCentralInertia(self.mass, load[1:], RotationalInertia(0.0, 0.0, 0.0))
            inertia += self._unloaded
        self._plant.get_body(self._chest).SetSpatialInertiaInBodyFrame(self._context, inertia)
