"""Contact properties of the ground for Drake's own contact models."""

from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, ProximityProperties
from pydrake.multibody.plant import CoulombFriction

from humanwalk.body.contact import FRICTION


def ground_properties(friction: float, hydroelastic: bool = False) -> ProximityProperties:
    """Return the properties of rigid ground on which a sole has a given friction coefficient.

    Drake combines the coefficients of two bodies to 2 m1 m2 / (m1 + m2), which is less than twice the smaller one. With
    the sole's m1 = `FRICTION` the ground needs m2 = friction m1 / (2 m1 - friction).

    Args:
        friction: Coulomb coefficient between sole and ground, static and dynamic; 0 <= friction < 2 `FRICTION`.
        hydroelastic: Whether soles press on the ground by pressure fields.

    Raises:
        ValueError: no ground has this coefficient with the sole.
    """
    if not 0.0 <= friction < 2.0 * FRICTION:
        raise ValueError(
            f"friction: {friction:g} is out of range; allowed: 0 to below {2.0 * FRICTION:g}, twice the sole's own "
            "coefficient; raise body.contact.FRICTION"
        )
    ground = friction * FRICTION / (2.0 * FRICTION - friction)
    properties = ProximityProperties()
    AddContactMaterial(friction=CoulombFriction(ground, ground), properties=properties)
    if hydroelastic:
        AddRigidHydroelasticProperties(properties)
    return properties
