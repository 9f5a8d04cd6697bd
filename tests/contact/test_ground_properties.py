"""Drake combines sole and ground to the terrain's coefficient of friction, and their stiffnesses in series."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    CalcContactFrictionFromSurfaceProperties,
    CoulombFriction,
)
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body.contact import FRICTION
from humanwalk.body.flesh import Flesh
from humanwalk.contact.ground_properties import ground_properties, set_ground_compliance
from humanwalk.numerics import Array

SOLE = CoulombFriction(FRICTION, FRICTION)
MU, RADIUS = 0.6, 0.05


def force_on_ball(flesh: Flesh, depth: float, slip: float = 0.0) -> Array:
    """Of the ground, on a ball with the properties of a sole [N], shape (3,)."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    set_ground_compliance(plant, scene_graph, flesh)
    sole = ProximityProperties()
    AddContactMaterial(flesh.sole_dissipation, flesh.sole_stiffness, SOLE, sole)
    ball = plant.AddRigidBody("ball", SpatialInertia.SolidSphereWithMass(1.0, RADIUS))
    plant.RegisterCollisionGeometry(ball, RigidTransform(), Sphere(RADIUS), "ball", sole)
    ground = ground_properties(MU)
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", ground)
    plant.Finalize()
    root = builder.Build().CreateDefaultContext()
    context = plant.GetMyMutableContextFromRoot(root)
    plant.SetPositionsAndVelocities(context, [1, 0, 0, 0, 0, 0, RADIUS - depth, 0, 0, 0, slip, 0, 0])
    contact = plant.get_contact_results_output_port().Eval(context).point_pair_contact_info(0)
    sign = 1.0 if contact.bodyB_index() == ball.index() else -1.0
    force: Array = sign * contact.contact_force()
    return force


@given(sole=st.floats(1e4, 1e6), ground=st.floats(1e4, 1e6))
def test_sole_and_ground_give_way_as_springs_in_series(sole: float, ground: float) -> None:
    depth = 3e-4
    force = force_on_ball(Flesh(sole_stiffness=sole, ground_stiffness=ground), depth)
    assert depth == pytest.approx(force[2] * (1.0 / sole + 1.0 / ground))


@pytest.mark.parametrize("slip_speed", [1e-4, 0.02])
def test_friction_grows_with_slip_up_to_the_slip_speed(slip_speed: float) -> None:
    flesh = Flesh(slip_speed=slip_speed)
    forces = [force_on_ball(flesh, 3e-4, share * slip_speed) for share in (0.5, 0.9, 1.0, 2.0)]
    shares = [-force[0] / (MU * force[2]) for force in forces]
    assert 0.0 < shares[0] < shares[1] < 1.0
    assert shares[2:] == pytest.approx([1.0, 1.0])


@given(friction=st.floats(0.0, 1.3))
def test_sole_and_ground_have_the_terrains_coefficient(friction: float) -> None:
    ground = ground_properties(friction).GetProperty("material", "coulomb_friction")
    together = CalcContactFrictionFromSurfaceProperties(SOLE, ground)
    assert together.static_friction() == pytest.approx(friction)
    assert together.dynamic_friction() == pytest.approx(friction)


@pytest.mark.parametrize("friction", [-0.1, 2.0 * FRICTION, 3.0])
def test_a_coefficient_that_no_ground_has_with_the_sole_is_refused(friction: float) -> None:
    with pytest.raises(ValueError, match=rf"^friction: {friction:g} is out of range; allowed: 0 to below 1\.4"):
        ground_properties(friction)


@pytest.mark.parametrize("hydroelastic", [False, True])
def test_ground_is_rigid_for_pressure_fields_where_these_are_used(hydroelastic: bool) -> None:
    assert ground_properties(0.7, hydroelastic).HasProperty("hydroelastic", "compliance_type") is hydroelastic
