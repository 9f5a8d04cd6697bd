"""What the spheres under the soles collide with: the ground alone, since feet touch each other with their capsules."""

from pydrake.geometry import CollisionFilterDeclaration, GeometrySet, Role, SceneGraph
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body import SOLE_SET
from humanwalk.body.limbs import LEGS


def filter_soles(plant: MultibodyPlant, scene_graph: SceneGraph, on_ground: bool) -> None:
    """Restrict the spheres under the soles of a finalized plant to collisions with the ground, or with nothing.

    Args:
        plant: of the walker.
        scene_graph: of the plant.
        on_ground: whether they collide with the ground.
    """
    inspector = scene_graph.model_inspector()
    soles = [
        GeometrySet(
            [
                geometry
                for body in leg.foot_bodies
                for geometry in plant.GetCollisionGeometriesForBody(plant.GetBodyByName(body))
                if SOLE_SET in inspector.GetName(geometry)
            ]
        )
        for leg in LEGS.values()
    ]
    declaration = CollisionFilterDeclaration().ExcludeBetween(*soles)
    if not on_ground:
        everything = GeometrySet(inspector.GetAllGeometryIds(Role.kProximity))
        for sole in soles:
            declaration.ExcludeBetween(sole, everything)
    scene_graph.collision_filter_manager().Apply(declaration)
