"""The contact of feet and ground: Drake's point or hydroelastic contact, or the thesis' asperity law."""

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from pydrake.geometry import ProximityProperties
from pydrake.multibody.plant import ContactModel

from humanwalk.body import SIDES, sole_patches
from humanwalk.choices.world import World
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.contact_step import body_jacobians
from humanwalk.contact.ground_properties import ground_properties
from humanwalk.contact.stable_step import largest_contact_step, patch_impedance
from humanwalk.numerics import Array
from humanwalk.numerics.stability import round_down
from humanwalk.quantity import ParameterError
from humanwalk.systems.asperity_contact import AsperityContact
from humanwalk.systems.foot_force_observer import FootForceObserver
from humanwalk.systems.leg_contact_observer import LegContactObserver


class Contact(Protocol):
    """One model of contact."""

    @property
    def leg_contact(self) -> bool:
        """Whether one leg stops the other; else they pass through each other."""

    @property
    def model(self) -> ContactModel:
        """Drake's contact model."""

    @property
    def collides_soles(self) -> bool:
        """Whether Drake collides the spheres under the soles with the ground."""

    def ground_properties(self, friction: float) -> ProximityProperties:
        """Properties of the ground for a Coulomb coefficient between sole and ground."""

    def add_to(self, world: World) -> None:
        """Add the system `foot_contact` with the outputs foot_forces and friction_use of `FootForceObserver`.

        With leg contact also `leg_contact`, a `LegContactObserver`.

        Raises:
            ParameterError: the contact cannot be simulated in this world.
        """


@dataclass(frozen=True)
class _DrakeContact:
    leg_contact: bool = True
    """Whether one leg stops the other; else they pass through each other."""
    collides_soles: ClassVar[bool] = True

    def ground_properties(self, friction: float) -> ProximityProperties:
        return ground_properties(friction)

    def add_to(self, world: World) -> None:
        observer = FootForceObserver(world.plant, world.scene_graph.model_inspector(), world.terrain)
        world.add("foot_contact", observer, contact_results=world.plant.get_contact_results_output_port())
        self._observe_legs(world)

    def _observe_legs(self, world: World) -> None:
        if self.leg_contact:
            observer = LegContactObserver(world.plant)
            world.add("leg_contact", observer, contact_results=world.plant.get_contact_results_output_port())


@dataclass(frozen=True)
class PointContact(_DrakeContact):
    """Six spheres under each foot, with Drake's point contact."""

    model = ContactModel.kPoint


@dataclass(frozen=True)
class HydroelasticContact(_DrakeContact):
    """Six compliant spheres under each foot, with Drake's hydroelastic contact on rigid ground."""

    model = ContactModel.kHydroelasticWithFallback

    def ground_properties(self, friction: float) -> ProximityProperties:
        return ground_properties(friction, hydroelastic=True)


@dataclass(frozen=True)
class AsperityContactModel(_DrakeContact, AsperityParameters):
    """The thesis' normal penalty and asperity friction on flat soles; Drake collides no foot with the ground."""

    model = ContactModel.kPoint
    collides_soles = False

    def add_to(self, world: World) -> None:
        if world.plant.time_step() == 0:
            raise ParameterError(
                "contact: asperity needs the discrete plant, whose step its forces are implicit in; allowed: with "
                "simulation.integrator: discrete; set it and a time_step, or contact: point"
            )
        self._require_stable(world)
        skeleton, step = world.subject.skeleton, world.plant.time_step()
        contact = AsperityContact(
            world.plant,
            {side: sole_patches(skeleton, side) for side in SIDES},
            world.terrain,
            self,
            _joint_impedance(world, step)[0],
        )
        world.add("foot_contact", contact, state=world.state)
        world.spatial_forces.append(contact.GetOutputPort("spatial_forces"))
        self._observe_legs(world)

    def _require_stable(self, world: World) -> None:
        """Raise ParameterError if the contact would diverge at the plant's step under the body at its start."""
        plant, context = world.plant, world.plant.CreateDefaultContext()
        patches = [patch for side in SIDES for patch in sole_patches(world.subject.skeleton, side)]
        bodies = [plant.GetBodyByName(patch.body) for patch in patches]
        J = body_jacobians(plant, context, bodies)
        p_BoQ_W = [
            body.EvalPoseInWorld(context).rotation().matrix() @ patch.p_BoQ_B.T
            for body, patch in zip(bodies, patches, strict=True)
        ]
        R_SW = world.terrain.axes(np.zeros(2))
        r, area = np.array(p_BoQ_W).swapaxes(1, 2), np.array([patch.area for patch in patches])
        stable = largest_contact_step(
            plant.CalcMassMatrix(context),
            J,
            patch_impedance(r, area, R_SW, self.normal_stiffness, self.spring_stiffness),
            patch_impedance(r, area, R_SW, self.normal_damping, self.velocity_stiffness),
            lambda h: _joint_impedance(world, h),
            _in_velocities(world, world.kp),
        )
        if plant.time_step() > stable:
            raise ParameterError(
                f"contact.asperity: unstable at time_step {plant.time_step():g} s; allowed: steps up to "
                f"{round_down(stable):g} s with these joints, stiffness and damping; lower simulation.time_step"
            )


CONTACTS: dict[str, type[Contact]] = {
    "point": PointContact,
    "hydroelastic": HydroelasticContact,
    "asperity": AsperityContactModel,
}
"""The contact models that a scenario can name."""


def _joint_impedance(world: World, step: float) -> tuple[Array, Array]:
    """`World.step_impedance` where the plant has the velocities of the joints, shape (nv,) each."""
    implicit, explicit = world.step_impedance(step)
    return _in_velocities(world, implicit), _in_velocities(world, explicit)


def _in_velocities(world: World, gains: Array) -> Array:
    """Gains in actuator order, put where the plant has the joints' velocities; shape (nv,)."""
    values = np.zeros(world.plant.num_velocities())
    values[world.joints.v] = gains
    return values
