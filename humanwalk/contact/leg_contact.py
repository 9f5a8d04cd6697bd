"""Legs that cannot pass through each other: capsules along thigh, shank and foot, which touch the other leg only."""

import numpy as np
from pydrake.geometry import (
    AddContactMaterial,
    Capsule,
    CollisionFilterDeclaration,
    GeometrySet,
    ProximityProperties,
    SceneGraph,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import CoulombFriction, MultibodyPlant

from humanwalk.body import SIDES, Skeleton
from humanwalk.body.anatomy import REFERENCE_STATURE

RADIUS = {"Femur_Thigh": 0.06, "Tibia": 0.045, "Ankle": 0.035}
"""Of the capsules of the reference human, by body [m]: inside of the flesh, which gives way (our choice)."""

FOOT_LENGTH = 0.21
"""Of the foot of the reference human from behind the ankle to its ball [m]."""

STIFFNESS = 2.0e4
"""Of the contact of one leg with the other [N/m] (our choice: flesh)."""

DISSIPATION = 1.0
"""Hunt-Crossley dissipation [s/m] (our choice)."""

FRICTION = 0.3
"""Cloth on cloth (our choice)."""


def add_leg_capsules(plant: MultibodyPlant, skeleton: Skeleton) -> None:
    """Add the capsules to a plant that is not finalised; `let_legs_touch` makes them count."""
    properties = ProximityProperties()
    AddContactMaterial(DISSIPATION, STIFFNESS, CoulombFriction(FRICTION, FRICTION), properties)
    scale = skeleton.stature / REFERENCE_STATURE
    for side in SIDES:
        bodies = {part: f"{side}Leg_{part}" for part in RADIUS}
        knee = skeleton.origins[bodies["Tibia"]] - skeleton.origins[bodies["Femur_Thigh"]]
        ankle = skeleton.origins[bodies["Ankle"]] - skeleton.origins[bodies["Tibia"]]
        foot = FOOT_LENGTH * scale * np.array((1.0, 0.0, 0.0))
        hind = np.array((-0.04, 0.0, -0.03)) * scale
        for part, begin, end in (
            ("Femur_Thigh", np.zeros(3), knee),
            ("Tibia", np.zeros(3), ankle),
            ("Ankle", hind, hind + foot),
        ):
            way = end - begin
            length, radius = float(np.linalg.norm(way)), RADIUS[part] * scale
            X_BG = RigidTransform(RotationMatrix.MakeFromOneVector(way, 2), 0.5 * (begin + end))
            plant.RegisterCollisionGeometry(
                plant.GetBodyByName(bodies[part]),
                X_BG,
                Capsule(radius, max(length - 2.0 * radius, 0.01)),
                f"{bodies[part]}{LEG_SET}",
                properties,
            )


LEG_SET = "_beside_the_other_leg"
"""End of the name of every capsule."""


def let_legs_touch(plant: MultibodyPlant, scene_graph: SceneGraph) -> None:
    """Filter the capsules of a finalised plant so that each meets those of the other leg and nothing else."""
    inspector = scene_graph.model_inspector()
    capsules: dict[str, GeometrySet] = {side: GeometrySet() for side in SIDES}
    others = GeometrySet()
    for geometry in inspector.GetAllGeometryIds():
        if inspector.GetProximityProperties(geometry) is None:
            continue
        name = inspector.GetName(geometry).rsplit("::", 1)[-1]
        (capsules["Right" if name.startswith("Right") else "Left"] if name.endswith(LEG_SET) else others).Add(geometry)
    filters = scene_graph.collision_filter_manager()
    for side in SIDES:
        filters.Apply(CollisionFilterDeclaration().ExcludeWithin(capsules[side]).ExcludeBetween(capsules[side], others))
