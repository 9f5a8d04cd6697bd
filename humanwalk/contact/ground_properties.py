"""Contact properties of the ground for Drake's own contact models."""

from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, ProximityProperties, SceneGraph
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant

from humanwalk.body.contact import FRICTION
from humanwalk.body.flesh import Flesh


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


def set_ground_compliance(plant: MultibodyPlant, scene_graph: SceneGraph, flesh: Flesh) -> None:
    """Set how the ground, which has no properties of its own, gives way below a body; before anything is registered."""
    config = scene_graph.get_config()
    config.default_proximity_properties.point_stiffness = flesh.ground_stiffness
    config.default_proximity_properties.hunt_crossley_dissipation = flesh.ground_dissipation
    config.default_proximity_properties.relaxation_time = flesh.ground_relaxation_time
    scene_graph.set_config(config)
    plant.set_stiction_tolerance(flesh.slip_speed)
