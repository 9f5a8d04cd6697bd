"""LeafSystem: the thesis' contact between soles and ground, as forces on the bodies of the feet."""

from collections.abc import Callable, Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.systems.framework import (
    BasicVector,
    Context,
    EventStatus,
    LeafSystem,
    OutputPort,
    State,
    ValueProducer,
)

from humanwalk.body.contact import SolePatch
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.contact_step import (
    ContactMemory,
    Contacts,
    ContactStep,
    body_jacobians,
    body_mobility,
    mobility_factor,
)
from humanwalk.contact.ground_force import foot_force
from humanwalk.numerics import Array
from humanwalk.terrain.ground import Ground


class AsperityContact(LeafSystem):
    """Normal force and asperity friction on patches of soles: b bodies, one patch of k points each, on f feet.

    The forces at a time are those that the law gives at the end of the step that begins then (see `ContactStep`).

    Inputs:
        state: plant state [q; v].

    Outputs:
        spatial_forces: list of ExternallyAppliedSpatialForce, for the plant's applied_spatial_force port.
        foot_forces: (8 f) as of FootForceObserver.
        friction_use: (f) as of FootForceObserver.
        point_forces: (3 b k) on each point in W [N].
        depth: (b k) of each point below the surface [m], negative above it.
        slip: (b k) speed of each pressing point along the surface [m/s].
        stretch: (b k) of the asperity springs [m].
        anchors: (3 b k) where the springs are fastened, in W [m].

    State, discrete: what each step leaves to the next, and the bodies' mobility, which is renewed more seldom.
    """

    def __init__(
        self,
        plant: MultibodyPlant,
        feet: Sequence[Sequence[SolePatch]],
        ground: Ground,
        parameters: AsperityParameters,
        joint_impedance: Array,
        mobility_period: float,
    ) -> None:
        """Make the contact of a finalised discrete plant.

        Args:
            plant: whose bodies touch; it must not collide them with the ground itself.
            feet: the patches of each foot, no two of one body, all with the same number of points.
            ground: the surface.
            parameters: of the law.
            joint_impedance: what the plant's step adds to the diagonal of its mass matrix, shape (nv,).
            mobility_period: time between two computations of the bodies' mobility [s].
        """
        super().__init__()
        self._plant, self._plant_context = plant, plant.CreateDefaultContext()
        self._joint_impedance = joint_impedance
        patches = [patch for foot in feet for patch in foot]
        self._bodies = [plant.GetBodyByName(patch.body) for patch in patches]
        self._frames, self._world = [body.body_frame() for body in self._bodies], plant.world_frame()
        # The origin comes first, so that one call gives it and all points.
        self._points = [np.vstack((np.zeros(3), patch.p_BoQ_B)).T for patch in patches]
        area = np.array([patch.area for patch in patches])
        b, k = area.shape
        rank = int(np.linalg.matrix_rank(body_jacobians(plant, self._plant_context, self._bodies)))
        self._contact_step = ContactStep(parameters, ground, area, plant.time_step(), rank)
        ends = np.cumsum([len(foot) for foot in feet])
        self._feet = [slice(end - len(foot), end) for foot, end in zip(feet, ends, strict=True)]
        self._forces = [ExternallyAppliedSpatialForce() for _ in self._bodies]
        for force, body in zip(self._forces, self._bodies, strict=True):
            force.body_index = body.index()

        self._state = self.DeclareVectorInputPort("state", plant.num_multibody_states())
        self._memory = [self.DeclareDiscreteState(size) for size in (3 * b * k, b * k, 3 * b * k, 6 * b, 6 * b)]
        self._mobility = self.DeclareDiscreteState(6 * b * rank)
        # Unrestricted, as the plant's step is: a simulator runs these before discrete updates, which would see a plant
        # that has already moved.
        self.DeclareInitializationUnrestrictedUpdateEvent(self._forget)
        self.DeclarePeriodicUnrestrictedUpdateEvent(plant.time_step(), 0.0, self._remember)
        self.DeclarePeriodicUnrestrictedUpdateEvent(mobility_period, 0.0, self._renew_mobility)

        self._contacts = self.DeclareCacheEntry(
            "contacts", ValueProducer(lambda: Value[object](), self._calc_contacts), {self.all_sources_ticket()}
        )
        after = {self._contacts.ticket()}
        self._forces_output = self.DeclareAbstractOutputPort(
            "spatial_forces",
            lambda: Value([ExternallyAppliedSpatialForce()]),
            self._calc_forces,
            prerequisites_of_calc=after,
        )

        def declare(name: str, size: int, value: Callable[[Contacts], Array]) -> OutputPort:
            def calc(context: Context, output: BasicVector) -> None:
                output.SetFromVector(value(self._contacts.Eval(context)).ravel())

            return self.DeclareVectorOutputPort(name, size, calc, prerequisites_of_calc=after)

        self._foot_forces_output = declare("foot_forces", 8 * len(feet), self._foot_forces)
        self._friction_use_output = declare("friction_use", len(feet), self._friction_use)
        self._point_forces_output = declare("point_forces", 3 * b * k, lambda contacts: contacts.force)
        self._depth_output = declare("depth", b * k, lambda contacts: -contacts.height)
        self._slip_output = declare("slip", b * k, lambda contacts: contacts.slip)
        self._stretch_output = declare("stretch", b * k, lambda contacts: contacts.stretch)
        self._anchors_output = self.DeclareStateOutputPort("anchors", self._memory[0])

    def _kinematics(self, context: Context) -> tuple[Array, Array, Array]:
        """Origins of the bodies (b, 3), their points (b k, 3) and their velocities (6 b) in W."""
        plant, inner, world = self._plant, self._plant_context, self._world
        plant.SetPositionsAndVelocities(inner, self._state.Eval(context))
        bodies = zip(self._frames, self._points, strict=True)
        p_W = np.concatenate([plant.CalcPointsPositions(inner, frame, points, world).T for frame, points in bodies])
        p_W = p_W.reshape(len(self._bodies), -1, 3)
        V = np.concatenate([body.EvalSpatialVelocityInWorld(inner).get_coeffs() for body in self._bodies])
        return p_W[:, 0], p_W[:, 1:].reshape(-1, 3), V

    def _calc_contacts(self, context: Context, output: Value) -> None:
        p_WB, p_WQ, V = self._kinematics(context)
        anchor, *others = (context.get_discrete_state(index).value() for index in self._memory)
        mobility = context.get_discrete_state(self._mobility).value().reshape(V.size, -1)
        memory = ContactMemory(anchor.reshape(-1, 3), *others)
        output.set_value(self._contact_step(p_WB, p_WQ, V, memory, mobility, context.get_time()))

    def _remember(self, context: Context, state: State) -> EventStatus:
        self._write(state, self._contacts.Eval(context).memory)
        return EventStatus.Succeeded()

    def _forget(self, context: Context, state: State) -> EventStatus:
        _, p_WQ, V = self._kinematics(context)
        self._write(state, ContactMemory.fresh(p_WQ, V))
        return self._renew_mobility(context, state)

    def _write(self, state: State, memory: ContactMemory) -> None:
        for index, value in zip(self._memory, memory, strict=True):
            state.get_mutable_discrete_state(index).set_value(value.ravel())

    def _renew_mobility(self, context: Context, state: State) -> EventStatus:
        plant, inner = self._plant, self._plant_context
        plant.SetPositionsAndVelocities(inner, self._state.Eval(context))
        G = body_mobility(
            plant.CalcMassMatrix(inner), body_jacobians(plant, inner, self._bodies), self._joint_impedance
        )
        factor = state.get_mutable_discrete_state(self._mobility)
        factor.set_value(mobility_factor(G, factor.size() // len(G)).ravel())
        return EventStatus.Succeeded()

    def _calc_forces(self, context: Context, output: Value) -> None:
        wrenches = self._contacts.Eval(context).memory.F.reshape(-1, 6)
        for force, wrench in zip(self._forces, wrenches, strict=True):
            force.F_Bq_W = SpatialForce(wrench)
        output.set_value(self._forces)

    def _foot_forces(self, contacts: Contacts) -> Array:
        return np.array([foot_force(*contacts.total(bodies)).vector for bodies in self._feet])

    def _friction_use(self, contacts: Contacts) -> Array:
        return np.array([contacts.friction_use(bodies) for bodies in self._feet])
