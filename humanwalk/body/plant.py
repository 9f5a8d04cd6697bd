"""The human inside a Drake MultibodyPlant."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from pydrake.multibody.parsing import PackageMap, Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ModelInstanceIndex

from humanwalk.body.anatomy import REFERENCE_MASS, REFERENCE_STATURE, human
from humanwalk.body.sdf import Look, to_sdf
from humanwalk.body.skeleton import MASS_RANGE_KG, STATURE_RANGE_M, Skeleton
from humanwalk.quantity import quantity

PACKAGE = "humanwalk"
HUMAN_URL = "package://humanwalk/models/sdf/human.sdf"
"""Model file of the reference human, for a parser after `register_package`."""


@dataclass(frozen=True)
class Subject:
    """The body that walks: the reference human, scaled."""

    mass: float = quantity(REFERENCE_MASS, "kg", *MASS_RANGE_KG)
    """Body mass (thesis 3.3.1: 70 kg)."""

    stature: float = quantity(REFERENCE_STATURE, "m", *STATURE_RANGE_M)
    """Standing height (thesis 3.3.1: 1.75 m)."""

    look: Look = "person"
    """Look of the body: a clothed person, or rods between joints with their axes and the contact spheres."""

    @property
    def skeleton(self) -> Skeleton:
        """The scaled skeleton."""
        if (self.mass, self.stature) == (REFERENCE_MASS, REFERENCE_STATURE):
            return human()
        return human().scaled(self.mass, self.stature)


def register_package(package_map: PackageMap) -> None:
    """Map `package://humanwalk/...` to the files of this package."""
    package_map.Add(PACKAGE, str(Path(__file__).parent.parent))


def add_human(plant: MultibodyPlant, subject: Subject) -> ModelInstanceIndex:
    """Parse the subject's model, strictly, into a plant that is not finalized, and return its instance."""
    parser = Parser(plant)
    parser.SetStrictParsing()
    register_package(parser.package_map())
    if subject == Subject():
        (instance,) = parser.AddModelsFromUrl(HUMAN_URL)
    else:
        (instance,) = parser.AddModelsFromString(to_sdf(subject.skeleton, subject.look), "sdf")
    return instance


@cache
def kinematics_plant(subject: Subject) -> MultibodyPlant:
    """Return a finalized plant of the subject alone, without geometry, for kinematics and inertia."""
    plant = MultibodyPlant(time_step=0.0)
    add_human(plant, subject)
    plant.Finalize()
    return plant
