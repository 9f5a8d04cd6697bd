"""Contact of the legs with each other: capsules along thigh, shank and foot, which collide with the other leg only."""

from collections.abc import Iterator

import numpy as np
from pydrake.geometry import (
    AddContactMaterial,
    Capsule,
    CollisionFilterDeclaration,
    GeometrySet,
    ProximityProperties,
    Role,
    SceneGraph,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant

from humanwalk.body import SIDES, Side, Skeleton
from humanwalk.body.limbs import LEGS
from humanwalk.numerics import Array

THIGH_RADIUS, SHANK_RADIUS, FOOT_RADIUS = 0.06, 0.045, 0.035
"""Radii of the capsules of the reference human [m]: less than those of the flesh, which gives way (our choice)."""

HEEL, BALL = np.array((-0.04, 0.0, -0.03)), np.array((0.17, 0.0, -0.03))
"""Rear and front end of the foot's capsule in the hindfoot's frame, of the reference human [m] (our choice)."""

FRICTION = 0.3
"""Coulomb coefficient, static and dynamic (our choice: cloth on cloth)."""

LEG_SET = "_leg_contact"
"""End of the name of every capsule."""


def add_leg_capsules(plant: MultibodyPlant, skeleton: Skeleton) -> None:
    """Register the capsules of both legs with a plant that is not finalized; `filter_leg_capsules` must follow."""
    properties = ProximityProperties()
    AddContactMaterial(
        skeleton.flesh.leg_dissipation, skeleton.flesh.leg_stiffness, CoulombFriction(FRICTION, FRICTION), properties
    )
    for side in SIDES:
        for body, start, end, radius in _capsules(skeleton, side):
            axis = end - start
            X_BG = RigidTransform(RotationMatrix.MakeFromOneVector(axis, 2), 0.5 * (start + end))
            shape = Capsule(radius, float(np.linalg.norm(axis)) - 2.0 * radius)
            plant.RegisterCollisionGeometry(plant.GetBodyByName(body), X_BG, shape, f"{body}{LEG_SET}", properties)


def _capsules(skeleton: Skeleton, side: Side) -> Iterator[tuple[str, Array, Array, float]]:
    """Body, ends including the caps in the body frame [m], shape (3,) each, and radius [m] of a leg's capsules."""
    leg, origins = LEGS[side], skeleton.origins
    thigh, shank, foot = (np.array(skeleton.size(body)) for body in leg.touching_bodies)
    yield leg.thigh, np.zeros(3), origins[leg.shank] - origins[leg.thigh], THIGH_RADIUS * thigh[0]
    yield leg.shank, np.zeros(3), origins[leg.hindfoot] - origins[leg.shank], SHANK_RADIUS * shank[0]
    yield leg.hindfoot, HEEL * foot, BALL * foot, FOOT_RADIUS * foot[1]


def filter_leg_capsules(plant: MultibodyPlant, scene_graph: SceneGraph) -> None:
    """Restrict the capsules of a finalized plant to collisions with those of the other leg."""
    inspector = scene_graph.model_inspector()
    capsules = {side: GeometrySet() for side in SIDES}
    others = set(inspector.GetAllGeometryIds(Role.kProximity))
    for side, leg in LEGS.items():
        for body in leg.touching_bodies:
            for geometry in plant.GetCollisionGeometriesForBody(plant.GetBodyByName(body)):
                if inspector.GetName(geometry).endswith(LEG_SET):
                    capsules[side].Add(geometry)
                    others.remove(geometry)
    filters = scene_graph.collision_filter_manager()
    for own in capsules.values():
        declaration = CollisionFilterDeclaration().ExcludeWithin(own)
        filters.Apply(declaration.ExcludeBetween(own, GeometrySet(list(others))))
