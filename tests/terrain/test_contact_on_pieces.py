"""Blocks on every piece of a course, with each contact model: the ground carries them, and no seam stops them."""

from typing import Any

import numpy as np
import pytest
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    ProximityProperties,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, ContactModel, CoulombFriction
from pydrake.multibody.tree import RigidBody, SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body import contact as soles
from humanwalk.body.contact import rectangle_patch
from humanwalk.body.flesh import Flesh
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.ground_properties import ground_properties
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.systems.asperity_contact import AsperityContact
from humanwalk.terrain import PIECES, Course
from humanwalk.terrain.height_map import HeightMap
from humanwalk.terrain.rough import Rough
from humanwalk.terrain.slope import Flat, Slope
from humanwalk.terrain.steps import Curb, Obstacle, Stairs, Stones

MODELS = ("point", "hydroelastic", "asperity")
FLESH = Flesh()
SIZE, MASS = (0.09, 0.08, 0.04), 8.0
WEIGHT = MASS * GRAVITY
SOLE = SIZE[0] * SIZE[1]
SUNK = {
    "point": WEIGHT / (4.0 * FLESH.sole_stiffness),
    "hydroelastic": np.sqrt(0.25 * WEIGHT / (np.pi * FLESH.sole_modulus)),
    "asperity": WEIGHT / (AsperityParameters().normal_stiffness * SOLE),
}
"""Depth at which the ground carries a block at rest [m]. The pressure of a compliant sphere is its modulus times the
depth over the radius, so that its force at depth d is pi times the modulus times d2."""

FINE_MESH = 0.25 * soles.SPHERE_RADIUS
"""Length of the edges of a compliant sphere for which this is true [m]; the mesh of a sole is coarser."""


class Blocks:
    """Blocks with soles like those of the feet, one at each of some points of a course."""

    def __init__(self, course: Course, model: str, places: Array, drop: float = 0.002, step: float = 2e-3) -> None:
        builder = DiagramBuilder()
        self.plant, _ = AddMultibodyPlantSceneGraph(builder, step)
        self.plant.set_contact_model(
            ContactModel.kHydroelasticWithFallback if model == "hydroelastic" else ContactModel.kPoint
        )
        course.add_to(self.plant, lambda friction: ground_properties(friction, hydroelastic=model == "hydroelastic"))
        self.bodies = [
            self.plant.AddRigidBody(f"block_{i}", SpatialInertia.SolidBoxWithMass(MASS, *SIZE))
            for i in range(len(places))
        ]
        for body in self.bodies:
            self._add_sole(body, model)
        self.plant.Finalize()
        self._asperity = None
        if model == "asperity":
            feet: Any = {
                body.name(): [rectangle_patch(body.name(), (0.0, 0.0, -0.5 * SIZE[2]), SIZE[:2], (2, 2))]
                for body in self.bodies
            }
            self._asperity = builder.AddSystem(
                AsperityContact(self.plant, feet, course, AsperityParameters(), np.zeros(self.plant.num_velocities()))
            )
            builder.Connect(self.plant.get_state_output_port(), self._asperity.GetInputPort("state"))
            builder.Connect(
                self._asperity.GetOutputPort("spatial_forces"), self.plant.get_applied_spatial_force_input_port()
            )
        self.simulator = Simulator(builder.Build())
        self.context = self.plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        for body, xy in zip(self.bodies, places, strict=True):
            R_WS = course.axes(xy).T
            p_WB = np.array((*xy, float(course.height(xy)))) + (0.5 * SIZE[2] + drop) * R_WS[:, 2]
            self.plant.SetFloatingBaseBodyPoseInWorldFrame(
                self.context, body, RigidTransform(RotationMatrix(R_WS), p_WB)
            )

    def _add_sole(self, body: RigidBody, model: str) -> None:
        properties = ProximityProperties()
        friction = CoulombFriction(soles.FRICTION, soles.FRICTION)
        AddContactMaterial(FLESH.sole_dissipation, FLESH.sole_stiffness, friction, properties)
        AddCompliantHydroelasticProperties(FINE_MESH, FLESH.sole_modulus, properties)
        if model != "asperity":
            radius = soles.SPHERE_RADIUS
            for x in (-1.0, 1.0):
                for y in (-1.0, 1.0):
                    center = (x * (0.5 * SIZE[0] - radius), y * (0.5 * SIZE[1] - radius), radius - 0.5 * SIZE[2])
                    self.plant.RegisterCollisionGeometry(
                        body, RigidTransform(np.array(center)), Sphere(radius), f"sole_{x}_{y}", properties
                    )

    def forces(self) -> Array:
        """Force of the ground on each block in W [N], shape (blocks, 3)."""
        if self._asperity is not None:
            context = self._asperity.GetMyContextFromRoot(self.simulator.get_context())
            forces: Array = self._asperity.GetOutputPort("foot_forces").Eval(context).reshape(-1, 8)[:, :3]
            return forces
        reaction = self.plant.get_generalized_contact_forces_output_port(
            self.plant.GetModelInstanceByName("DefaultModelInstance")
        ).Eval(self.context)
        return reaction.reshape(-1, 6)[:, 3:]

    def velocities(self) -> Array:
        """Translational velocity of each block in W [m/s], shape (blocks, 3)."""
        return np.array(
            [self.plant.EvalBodySpatialVelocityInWorld(self.context, body).translational() for body in self.bodies]
        )


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """Every piece, with a face under its middle on which a block can lie."""
    path = tmp_path_factory.mktemp("map") / "map.csv"
    path.write_text("\n".join(",".join(f"{0.02 * ((i * j) % 4):g}" for i in range(9)) for j in range(15)))
    return Course(
        (
            Flat(),
            Slope(slope=0.2),
            Slope(slope=-0.1, cross_slope=0.2),
            Stairs(number=3),
            Stairs(number=3, direction="down"),
            Curb(),
            Rough(height=0.05, length=2.0),
            Obstacle(),
            Stones(number=3, height=0.1),
            HeightMap(file=str(path), cell_size=0.2),
        ),
        width=3.0,
    )


def middles(course: Course) -> Array:
    """The middle of the middle face of each piece, and a point beside the strip."""
    places, x = [], course.run_up
    for piece in course.pieces:
        faces = piece.faces(course.width)
        face = faces[len(faces) // 2]
        places.append(0.5 * (np.array(face.lower) + face.upper) + (x, 0.0))
        x += max(face.upper[0] for face in faces)
    return np.array([*places, (x, course.width)])


def test_every_piece_is_here(course: Course) -> None:
    assert {type(piece) for piece in course.pieces} == set(PIECES.values())


@pytest.mark.parametrize("model", MODELS)
def test_every_piece_carries_a_dropped_block(course: Course, model: str) -> None:
    places = middles(course)
    blocks = Blocks(course, model, places)
    blocks.simulator.AdvanceTo(0.3)
    np.testing.assert_allclose(blocks.forces()[:, 2], WEIGHT, rtol=0.01)
    np.testing.assert_allclose(blocks.forces()[:, :2], 0.0, atol=0.01 * WEIGHT)
    for body, xy in zip(blocks.bodies, places, strict=True):
        p_WB = blocks.plant.EvalBodyPoseInWorld(blocks.context, body).translation()
        # Landing on a slope it slips a little before friction holds it.
        np.testing.assert_allclose(p_WB[:2], xy + 0.5 * SIZE[2] * course.axes(xy)[2, :2], atol=2e-3)
        height = (p_WB[2] - float(course.height(p_WB[:2]))) * course.axes(xy)[2, 2]
        assert height == pytest.approx(0.5 * SIZE[2] - SUNK[model], abs=3e-4)


@pytest.mark.parametrize("model", MODELS)
def test_friction_in_motion_is_that_of_each_piece(model: str) -> None:
    """While a block slides, the impulse of friction is mu times that of the normal force.

    A block on compliant spheres bounces, and Drake's friction of a step follows the normal force of the step before.
    """
    mu = np.array((0.1, 0.25, 0.4, 0.7))
    course = Course(tuple(Flat(friction_coefficient=float(value), length=2.0) for value in mu))
    blocks = Blocks(course, model, np.column_stack((1.3 + 2.0 * np.arange(4), np.zeros(4))), drop=-SUNK[model])
    for body in blocks.bodies:
        velocity = SpatialVelocity(np.zeros(3), np.array((0.0, 1.0, 0.0)))
        blocks.plant.SetFreeBodySpatialVelocity(context=blocks.context, body=body, V_JpJc=velocity)
    forces = []
    for step in range(20, 50):
        blocks.simulator.AdvanceTo(2e-3 * step)
        forces.append(blocks.forces())
    assert (blocks.velocities()[:, 1] > 0.1).all()
    _, f_y, f_z = np.sum(forces, axis=0).T
    np.testing.assert_allclose(-f_y / f_z, mu, rtol=0.02)


@pytest.mark.parametrize("model", MODELS)
def test_no_seam_stops_a_sliding_block(model: str) -> None:
    """Level seams at x = 1, 1.1, 1.2, ...: as on ground in one piece, whose friction alone slows a block down."""
    ice = 0.05
    seams = Course(tuple(Flat(friction_coefficient=ice, length=0.1) for _ in range(12)), friction_coefficient=ice)
    speeds = []
    for course in (seams, Course(friction_coefficient=ice)):
        blocks = Blocks(course, model, np.array(((0.9, 0.0), (0.9, 1.0))), drop=-SUNK[model])
        for body in blocks.bodies:
            velocity = SpatialVelocity(np.zeros(3), np.array((2.0, 0.0, 0.0)))
            blocks.plant.SetFreeBodySpatialVelocity(context=blocks.context, body=body, V_JpJc=velocity)
        blocks.simulator.AdvanceTo(0.4)
        speeds.append(blocks.velocities()[:, 0])
    np.testing.assert_allclose(speeds[0], speeds[1], atol=0.03)
    np.testing.assert_allclose(speeds[1], 2.0 - ice * GRAVITY * 0.4, atol=0.03)


@pytest.mark.parametrize("model", MODELS)
def test_a_riser_stops_a_sliding_block(model: str) -> None:
    course = Course((Flat(length=1.0, friction_coefficient=0.05), Curb(height=0.1)))
    blocks = Blocks(course, model, np.array(((1.7, 0.0),)), drop=-SUNK[model], step=1e-3)
    velocity = SpatialVelocity(np.zeros(3), np.array((1.0, 0.0, 0.0)))
    blocks.plant.SetFreeBodySpatialVelocity(context=blocks.context, body=blocks.bodies[0], V_JpJc=velocity)
    blocks.simulator.AdvanceTo(0.4)
    p_WB = blocks.plant.EvalBodyPoseInWorld(blocks.context, blocks.bodies[0]).translation()
    assert p_WB[0] < 2.0 - 0.5 * SIZE[0] + 5e-3
    assert p_WB[2] < 0.06
    assert abs(blocks.velocities()[0, 0]) < 0.6
