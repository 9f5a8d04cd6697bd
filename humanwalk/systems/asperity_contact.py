"""LeafSystem: the thesis' contact between soles and ground, as forces on the bodies of the feet."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import RigidBody
from pydrake.systems.framework import Context, EventStatus, LeafSystem, State

from humanwalk.body import Side
from humanwalk.body.contact import SolePatch
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.contact_step import ContactMemory, ContactStep, body_jacobians, body_mobility, mobility_factor
from humanwalk.contact.ground_force import FootForce, foot_force
from humanwalk.numerics import Array
from humanwalk.systems.abstract_output import declare_abstract_output
from humanwalk.systems.foot_signals import declare_foot_signals
from humanwalk.terrain import Terrain


class AsperityContact(LeafSystem):
    """Normal force and asperity friction on patches of soles: b bodies, one patch of k points each, on f feet.

    The forces at a time are those that the law gives at the end of the step that begins then (see `ContactStep`).

    Inputs:
        state: plant state [q; v].

    Outputs:
        contacts: `Contacts`, as `ContactStep` returns them.
        spatial_forces: list of ExternallyAppliedSpatialForce, for the plant's applied_spatial_force port.
        foot_forces: (8 f) as of FootForceObserver.
        friction_use: (f) as of FootForceObserver.

    State, discrete: what each step passes to the next, and the mobility of the bodies, which is updated less often.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        feet: Mapping[Side, Sequence[SolePatch]],
        terrain: Terrain,
        parameters: AsperityParameters,
        joint_impedance: Array,
    ) -> None:
        """Initialize the contact.

        Args:
            plant: Finalized discrete plant; it must not collide the patches' bodies with the ground.
            feet: The patches of each foot, no two of one body, all with the same number of points.
            terrain: The ground.
            parameters: Of the law.
            joint_impedance: What the plant's step adds to the diagonal of its mass matrix, shape (nv,).
        """
        super().__init__()
        self._plant, self._plant_context = plant, plant.CreateDefaultContext()
        self._terrain, self._joint_impedance = terrain, joint_impedance
        patches = [patch for foot in feet.values() for patch in foot]
        self._body_indices = [plant.GetBodyByName(patch.body).index() for patch in patches]
        # The origin comes first, so that one call returns it together with the points.
        self._points = [np.vstack((np.zeros(3), patch.p_BoQ_B)).T for patch in patches]
        area = np.array([patch.area for patch in patches])
        b, k = area.shape
        rank = int(np.linalg.matrix_rank(body_jacobians(plant, self._plant_context, self._bodies)))
        self._contact_step = ContactStep(parameters, terrain, area, plant.time_step())
        self._forces = [ExternallyAppliedSpatialForce() for _ in patches]
        for force, index in zip(self._forces, self._body_indices, strict=True):
            force.body_index = index
        ends = k * np.cumsum([0, *map(len, feet.values())])
        self._points_of_feet = [slice(*ends) for ends in pairwise(ends)]

        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._memory_shapes = ((b * k, 3), (b * k,), (b * k, 3), (6 * b,), (6 * b,))
        self._memory = [self.DeclareDiscreteState(int(np.prod(shape))) for shape in self._memory_shapes]
        self._mobility = self.DeclareDiscreteState(6 * b * rank)
        # Unrestricted, as the plant's step is: a simulator runs these before discrete updates, which would see a plant
        # that has already moved.
        self.DeclareInitializationUnrestrictedUpdateEvent(self._initialize)
        self.DeclarePeriodicUnrestrictedUpdateEvent(plant.time_step(), 0.0, self._update_memory)
        self.DeclarePeriodicUnrestrictedUpdateEvent(parameters.mobility_period, 0.0, self._update_mobility)

        self._contacts = declare_abstract_output(self, "contacts", Value[object](), self._calc_contacts)
        forces = Value([ExternallyAppliedSpatialForce()])
        declare_abstract_output(self, "spatial_forces", forces, self._calc_forces)
        self.signals = declare_foot_signals(self, tuple(feet), self._calc_feet)

    @property
    def _bodies(self) -> list[RigidBody]:
        return [self._plant.get_body(index) for index in self._body_indices]

    def _kinematics(self, context: Context) -> tuple[Array, Array, Array]:
        """Origins of the bodies (b, 3), their points (b k, 3) and their velocities (6 b) in W."""
        plant, inner, bodies = self._plant, self._plant_context, self._bodies
        plant.SetPositionsAndVelocities(inner, self._state.Eval(context))
        frames, world = [body.body_frame() for body in bodies], plant.world_frame()
        points = zip(frames, self._points, strict=True)
        p_W = np.array([plant.CalcPointsPositions(inner, frame, p_BQ, world).T for frame, p_BQ in points])
        V = np.concatenate([body.EvalSpatialVelocityInWorld(inner).get_coeffs() for body in bodies])
        return p_W[:, 0], p_W[:, 1:].reshape(-1, 3), V

    def _calc_contacts(self, context: Context, output: Value) -> None:
        p_WB, p_WQ, V = self._kinematics(context)
        values = (context.get_discrete_state(index).value() for index in self._memory)
        memory = ContactMemory(
            *(value.reshape(shape) for value, shape in zip(values, self._memory_shapes, strict=True))
        )
        mobility = context.get_discrete_state(self._mobility).value().reshape(V.size, -1)
        output.set_value(self._contact_step(p_WB, p_WQ, V, memory, mobility, context.get_time()))

    def _update_memory(self, context: Context, state: State) -> EventStatus:
        self._write(state, self._contacts.Eval(context).memory)
        return EventStatus.Succeeded()

    def _initialize(self, context: Context, state: State) -> EventStatus:
        _, p_WQ, V = self._kinematics(context)
        self._write(state, ContactMemory.untouched(p_WQ, V))
        return self._update_mobility(context, state)

    def _write(self, state: State, memory: ContactMemory) -> None:
        for index, value in zip(self._memory, memory, strict=True):
            state.get_mutable_discrete_state(index).set_value(value.ravel())

    def _update_mobility(self, context: Context, state: State) -> EventStatus:
        plant, inner = self._plant, self._plant_context
        plant.SetPositionsAndVelocities(inner, self._state.Eval(context))
        J = body_jacobians(plant, inner, self._bodies)
        G = body_mobility(plant.CalcMassMatrix(inner), J, self._joint_impedance)
        factor = state.get_mutable_discrete_state(self._mobility)
        factor.set_value(mobility_factor(G, factor.size() // len(G)).ravel())
        return EventStatus.Succeeded()

    def _calc_forces(self, context: Context, output: Value) -> None:
        wrenches = self._contacts.Eval(context).memory.F.reshape(-1, 6)
        for force, wrench in zip(self._forces, wrenches, strict=True):
            force.F_Bq_W = SpatialForce(wrench)
        output.set_value(self._forces)

    def _calc_feet(self, context: Context) -> list[FootForce]:
        contacts = self._contacts.Eval(context)
        p_WQ, f_W = contacts.p_WQ, contacts.f_W
        return [foot_force(p_WQ[foot], f_W[foot], self._terrain) for foot in self._points_of_feet]
