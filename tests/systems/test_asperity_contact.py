"""Asperity contact as a system: blocks stand, stick, slide, break away and bounce as mechanics predicts."""

import dataclasses
import math

import numpy as np
import pytest
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, ExternallyAppliedSpatialForce
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body.contact import SolePatch, rectangle_patch
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.stable_step import MAX_STEP
from humanwalk.numerics import Array
from humanwalk.quantity import GRAVITY
from humanwalk.systems.asperity_contact import AsperityContact
from humanwalk.terrain import Plane

LAW = AsperityParameters()
MU = Plane().friction_coefficient
MASS = 10.0
SIZE = (0.3, 0.2, 0.1)
AREA = SIZE[0] * SIZE[1]
SUNK = MASS * GRAVITY / (LAW.normal_stiffness * AREA)


class Block:
    """A block on a plane that goes down forward; positions and velocities along the slope, across and normal to it."""

    def __init__(
        self,
        slope: float = 0.0,
        law: AsperityParameters = LAW,
        velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
        height: float = -SUNK,
        step: float = 1e-3,
        patch: SolePatch | None = None,
    ) -> None:
        self.R = RotationMatrix.MakeYRotation(slope)
        builder = DiagramBuilder()
        self.plant, _ = AddMultibodyPlantSceneGraph(builder, step)
        self.body = self.plant.AddRigidBody("block", SpatialInertia.SolidBoxWithMass(MASS, *SIZE))
        self.plant.Finalize()
        self.contact = builder.AddSystem(
            AsperityContact(
                self.plant,
                {"Right": [patch or rectangle_patch("block", (0.0, 0.0, -0.5 * SIZE[2]), SIZE[:2], (3, 3))]},
                Plane(slope=-slope),
                law,
                np.zeros(6),
            )
        )
        builder.Connect(self.plant.get_state_output_port(), self.contact.GetInputPort("state"))
        builder.Connect(self.contact.GetOutputPort("spatial_forces"), self.plant.get_applied_spatial_force_input_port())
        self.simulator = Simulator(builder.Build())
        self.context = self.plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        p_WB = self.R @ np.array([0.0, 0.0, 0.5 * SIZE[2] + height])
        self.plant.SetFloatingBaseBodyPoseInWorldFrame(self.context, self.body, RigidTransform(self.R, p_WB))
        self.plant.SetFreeBodySpatialVelocity(
            context=self.context, body=self.body, V_JpJc=SpatialVelocity(np.zeros(3), self.R @ np.array(velocity))
        )
        self.push(0.0)

    def push(self, force: float) -> None:
        """A force along the slope through the center of mass [N]."""
        generalized = np.zeros(6)
        generalized[3:] = self.R @ np.array([force, 0.0, 0.0])
        self.plant.get_applied_generalized_force_input_port().FixValue(self.context, generalized)

    def until(self, time: float) -> "Block":
        self.simulator.AdvanceTo(time)
        return self

    @property
    def position(self) -> Array:
        return self.R.inverse() @ self.plant.EvalBodyPoseInWorld(self.context, self.body).translation()

    @property
    def velocity(self) -> Array:
        return self.R.inverse() @ self.plant.EvalBodySpatialVelocityInWorld(self.context, self.body).translational()

    def output(self, name: str) -> Array | list[ExternallyAppliedSpatialForce]:
        context = self.contact.GetMyContextFromRoot(self.simulator.get_context())
        return self.contact.GetOutputPort(name).Eval(context)


def test_ports() -> None:
    contact = Block().contact
    ports = [contact.get_output_port(i) for i in range(contact.num_output_ports())]
    sizes = {port.get_name(): port.size() for port in ports}
    assert sizes == {"contacts": 0, "spatial_forces": 0, "foot_forces": 8, "friction_use": 1}
    assert all(name in AsperityContact.__doc__ for name in sizes)  # type: ignore[operator]
    assert contact.num_input_ports() == 1
    assert contact.GetInputPort("state").size() == 13


def test_signals_have_a_column_for_every_element_of_their_port() -> None:
    forces, friction_use = Block().contact.signals
    assert [signal.name for signal in (forces, friction_use)] == ["foot_forces", "friction_use"]
    assert [len(signal.columns) for signal in (forces, friction_use)] == [8, 1]
    assert forces.columns[2] == "right_foot.force_z_N"


def test_the_foot_forces_are_the_force_on_the_body() -> None:
    block = Block(slope=0.2).until(0.1)
    (force,) = block.output("spatial_forces")
    f_W, p_WCop, free_moment = np.split(block.output("foot_forces")[:7], (3, 6))  # type: ignore[type-var]
    np.testing.assert_allclose(force.F_Bq_W.translational(), f_W, atol=1e-6)  # type: ignore[arg-type]
    p_WB = block.R @ block.position  # type: ignore[arg-type]
    moment = np.cross(p_WCop - p_WB, f_W) + free_moment * block.R.col(2)  # type: ignore[arg-type]
    # The points are those of the end of the step.
    np.testing.assert_allclose(force.F_Bq_W.rotational(), moment, atol=1e-6)


# Standing.


@pytest.mark.parametrize("stiffness", [1.5e7, 5e7])
def test_standing_it_sinks_by_weight_over_stiffness_and_area(stiffness: float) -> None:
    law = dataclasses.replace(LAW, normal_stiffness=stiffness)
    block = Block(law=law, height=0.001).until(0.6)
    sunk = MASS * GRAVITY / (stiffness * AREA)
    assert 0.5 * SIZE[2] - block.position[2] == pytest.approx(sunk, rel=1e-4)
    np.testing.assert_allclose(block.output("foot_forces")[:3], [0.0, 0.0, MASS * GRAVITY], atol=1e-3)  # type: ignore[arg-type]
    np.testing.assert_allclose(block.output("foot_forces")[3:6], 0.0, atol=1e-5)  # type: ignore[arg-type]


def test_in_the_air_there_is_no_force() -> None:
    block = Block(height=0.1).until(0.05)
    for name in ("foot_forces", "friction_use"):
        np.testing.assert_array_equal(block.output(name), 0.0)


# Friction.


@pytest.mark.parametrize(("share", "duration", "step"), [(0.5, 1.0, 1e-3), (0.97, 10.0, 2e-3)])
def test_below_the_friction_angle_it_sticks(share: float, duration: float, step: float) -> None:
    block = Block(math.atan(share * MU), step=step).until(0.5)
    before = block.position
    block.until(0.5 + duration)
    np.testing.assert_allclose(block.position, before, atol=1e-9)
    assert block.output("friction_use")[0] == pytest.approx(share, rel=1e-3)
    # The ground carries the weight.
    np.testing.assert_allclose(block.output("foot_forces")[:3], (0.0, 0.0, MASS * GRAVITY), atol=1e-2)  # type: ignore[arg-type]


@pytest.mark.parametrize("share", [1.05, 1.5])
def test_above_the_friction_angle_it_slides_with_coulomb_friction(share: float) -> None:
    slope = math.atan(share * MU)
    block = Block(slope).until(0.3)
    before = block.velocity[0]
    block.until(1.3)
    acceleration = GRAVITY * (math.sin(slope) - MU * math.cos(slope))
    assert block.velocity[0] - before == pytest.approx(acceleration, rel=0.01)
    assert block.output("friction_use")[0] == pytest.approx(1.0)


def test_between_breaking_factor_and_one_the_velocity_law_lets_it_creep() -> None:
    block = Block(math.atan(0.98 * MU)).until(0.5)
    before = block.position[0]
    block.until(2.5)
    carried = LAW.velocity_stiffness * AREA
    normal = MASS * GRAVITY * math.cos(math.atan(0.98 * MU))
    creep = 2.0 * (0.98 - LAW.breaking_factor) * MU * normal / carried
    assert block.position[0] - before == pytest.approx(creep, rel=0.05)


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0])
def test_a_sliding_block_stops_after_the_square_of_its_speed_over_twice_mu_g(speed: float) -> None:
    """But for the time in which the mean load rises: two or three steps of 1 / (1 - averaging)."""
    block = Block(velocity=(speed, 0.0, 0.0)).until(speed / (MU * GRAVITY) + 0.2)
    distance = speed**2 / (2.0 * MU * GRAVITY)
    assert distance < block.position[0] < distance + speed * 3e-3 * LAW.averaging / (1.0 - LAW.averaging)
    np.testing.assert_allclose(block.velocity, 0.0, atol=1e-6)


@pytest.mark.parametrize("factor", [0.5, 0.975])
def test_it_breaks_away_at_the_breaking_factor_times_mu_times_its_weight(factor: float) -> None:
    law = dataclasses.replace(LAW, breaking_factor=factor)
    limit = factor * MU * MASS * GRAVITY
    held, loose = (Block(law=law), Block(law=law))
    for block, force in ((held, 0.98 * limit), (loose, 1.02 * limit)):
        block.push(force)
        # The force tips the block a little: points at its rear, which press less, slip first and share out their load.
        block.until(0.75)
        block.at_rest = block.position[0]  # type: ignore[attr-defined]
        block.until(1.25)
    assert abs(held.position[0] - held.at_rest) < 1e-9  # type: ignore[attr-defined]
    assert loose.position[0] - loose.at_rest > 1e-6  # type: ignore[attr-defined]


# Bouncing.


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.5])
def test_a_bouncing_ball_has_the_restitution_of_its_damping(ratio: float) -> None:
    """Coefficient of restitution of a linear spring-damper that never pulls (Schwager and Poeschel 2007)."""
    omega = 300.0
    point = SolePatch("block", np.array([[0.0, 0.0, -0.5 * SIZE[2]]]), np.array([1e-3]))
    law = dataclasses.replace(
        LAW, normal_stiffness=MASS * omega**2 / 1e-3, normal_damping=2.0 * ratio * omega * MASS / 1e-3
    )
    speed = 1.0
    ball = Block(law=law, velocity=(0.0, 0.0, -speed), height=0.0, step=2e-5, patch=point)
    duration = 1.5 * math.pi / omega
    ball.until(duration)
    damped = math.sqrt(1.0 - ratio**2)
    turn = math.pi - math.atan2(2.0 * ratio * damped, 1.0 - 2.0 * ratio**2)
    restitution = math.exp(-ratio / damped * turn)
    contact_time = turn / (damped * omega)
    assert ball.output("foot_forces")[2] == 0.0
    expected = restitution * speed - GRAVITY * (duration - contact_time)
    assert ball.velocity[2] == pytest.approx(expected, abs=0.03)


# Steps.


@pytest.mark.parametrize("stiffness", [5e7, 2e8])
def test_at_the_longest_step_it_lands_on_a_slope_and_sticks(stiffness: float) -> None:
    law = dataclasses.replace(LAW, normal_stiffness=stiffness)
    block = Block(math.atan(0.5 * MU), law, step=MAX_STEP, height=0.002).until(0.5)
    before = block.position
    block.until(0.8)
    np.testing.assert_allclose(block.position, before, atol=1e-9)
