"""LeafSystem: ground reaction force and center of pressure of each foot."""

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import SceneGraphInspector
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.multibody.tree import BodyIndex
from pydrake.systems.framework import Context, LeafSystem

from humanwalk.body import SIDES, Side
from humanwalk.body.limbs import LEGS
from humanwalk.contact.ground_force import NO_FORCE, FootForce, foot_force
from humanwalk.numerics import Array
from humanwalk.systems.foot_signals import declare_foot_signals
from humanwalk.terrain import Terrain

NO_MOMENT = np.zeros(3)


class FootForceObserver(LeafSystem):
    """Sums the plant's contacts with the ground, point and hydroelastic, over the bodies of each foot.

    Inputs:
        contact_results: the plant's ContactResults.

    Outputs:
        foot_forces: (16) right foot, then left foot, each: force on the foot in W [N] x y z, center of pressure in W
            [m] x y z, free moment about the surface normal [N m], loaded (1 or 0). The last five are 0 while the foot
            is unloaded.
        friction_use: (2) right, left: tangential force over friction coefficient times normal force; 0 while the foot
            is unloaded.
    """

    def __init__(self, plant: MultibodyPlant, inspector: SceneGraphInspector, terrain: Terrain) -> None:
        """Initialize the observer.

        Args:
            plant: Finalized plant.
            inspector: Of the plant's scene graph; maps the geometries of contact surfaces to bodies.
            terrain: The ground.
        """
        super().__init__()
        self._terrain = terrain
        # Foot and sign by the bodies A and B of a contact: the contact force acts on B. Other pairs are not counted.
        self._foot: dict[tuple[BodyIndex, BodyIndex], tuple[Side, float]] = {}
        world = plant.world_body().index()
        for side in SIDES:
            for name in LEGS[side].foot_bodies:
                of_foot = plant.GetBodyByName(name).index()
                self._foot |= {(world, of_foot): (side, 1.0), (of_foot, world): (side, -1.0)}
        self._body_of_geometry = {
            geometry: body.index()
            for geometry in inspector.GetAllGeometryIds()
            if (body := plant.GetBodyFromFrameId(inspector.GetFrameId(geometry))) is not None
        }
        self._contacts = self.DeclareAbstractInputPort("contact_results", Value(ContactResults()))
        self.signals = declare_foot_signals(self, SIDES, self._calc_feet)

    def _calc_feet(self, context: Context) -> list[FootForce]:
        results = self._contacts.Eval(context)
        # Of every contact of a foot: point, force and moment on the foot in W.
        contacts: dict[Side, list[tuple[Array, Array, Array]]] = {side: [] for side in SIDES}

        def add(A: BodyIndex, B: BodyIndex, point: Array, force: Array, moment: Array) -> None:
            if (A, B) in self._foot:
                side, sign = self._foot[A, B]
                contacts[side].append((point, sign * force, sign * moment))

        for i in range(results.num_point_pair_contacts()):
            pair = results.point_pair_contact_info(i)
            add(pair.bodyA_index(), pair.bodyB_index(), pair.contact_point(), pair.contact_force(), NO_MOMENT)
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            surface, F = info.contact_surface(), info.F_Ac_W()
            # The force is that on M, at the centroid.
            N, M = self._body_of_geometry[surface.id_N()], self._body_of_geometry[surface.id_M()]
            add(N, M, surface.centroid(), F.translational(), F.rotational())
        feet = dict.fromkeys(SIDES, NO_FORCE)
        for side in feet:
            if contacts[side]:
                p_WQ, f_W, m_W = np.array(contacts[side]).swapaxes(0, 1)
                feet[side] = foot_force(p_WQ, f_W, self._terrain, m_W)
        return list(feet.values())
